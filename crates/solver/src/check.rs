//! What a run checks of itself.

pub mod ledger;
pub mod limit;
pub mod linear;
pub mod watchdog;
