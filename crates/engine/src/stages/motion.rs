//! Motion of single particles: kick and drift, supports, loads, local damping, sleep.

pub mod kick_and_drift;
pub mod loads;
pub mod local_damping;
pub(crate) mod resting;
pub(crate) mod riding;
pub(crate) mod sleep;
pub mod supports;
