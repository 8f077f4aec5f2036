//! Data of the neighbour search.

pub(crate) mod buffers;
pub mod clusters;
pub mod references;
pub mod rigid_balls;
