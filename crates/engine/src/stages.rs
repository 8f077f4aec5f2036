//! The physics of the time step, one stage per file.

pub mod bonds;
pub mod chunks;
pub mod clumps;
pub mod clusters;
pub mod contacts;
pub mod ledger;
pub mod motion;
pub mod population;
pub mod search;
pub mod stage;
pub mod walls;
pub mod watching;
