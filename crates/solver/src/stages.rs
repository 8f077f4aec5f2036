//! The physics of the time step, one stage per file.

pub(crate) mod blocks;
pub mod bonds;
pub mod breakage;
pub mod clumps;
pub mod contacts;
mod damped;
pub mod damping;
pub(crate) mod flow;
pub mod incremental;
pub(crate) mod inlets;
pub(crate) mod lanes;
pub mod ledger;
pub(crate) mod listing;
pub mod loads;
pub mod motion;
pub mod neighbours;
mod outlets;
pub(crate) mod pieces;
pub mod population;
pub(crate) mod replacement;
pub mod restoring;
pub(crate) mod sleep;
pub mod stage;
pub mod supports;
pub mod totals;
pub mod walls;
pub(crate) mod watching;
