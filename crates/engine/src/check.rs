//! Checks that a run makes of itself.

pub mod flight;
pub mod limit;
pub mod linearised_contacts;
pub mod lowest_frequency;
pub mod pass_through;
pub mod validity;
pub mod watchdog;
