//! Checks that a run makes of itself.

pub(crate) mod flight;
pub(crate) mod laws;
pub mod limit;
pub mod linear;
pub mod lowest_frequency;
pub(crate) mod passing;
pub mod watchdog;
