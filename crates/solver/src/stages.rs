//! Physics over the state, in the order of the step.

mod blocks;
pub mod bonds;
pub mod breakage;
pub mod clumps;
pub mod contacts;
pub mod damping;
pub mod incremental;
mod lanes;
pub mod listing;
pub mod loads;
pub mod motion;
pub mod neighbours;
pub mod population;
pub mod replacement;
pub mod restoring;
pub mod sleep;
pub mod supports;
pub mod walls;
pub mod watching;
