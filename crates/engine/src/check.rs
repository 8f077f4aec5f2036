//! Checks that a run makes of itself.

pub mod flight;
pub mod laws;
pub mod limit;
pub mod linear;
pub mod lowest_frequency;
pub mod passing;
pub mod watchdog;
