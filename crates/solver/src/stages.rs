//! The physics of the time step, one stage per file.

mod blocks;
pub mod bonds;
pub mod breakage;
pub mod clumps;
pub mod contacts;
pub mod damping;
pub mod flow;
pub mod incremental;
pub mod inlets;
mod lanes;
pub mod ledger;
pub mod listing;
pub mod loads;
pub mod motion;
pub mod neighbours;
mod outlets;
pub mod pieces;
pub mod population;
pub mod replacement;
pub mod restoring;
pub mod sleep;
pub mod stage;
pub mod supports;
pub mod totals;
pub mod walls;
pub mod watching;
