//! Physics over the state, in the order of the step.

pub mod bonds;
pub mod motion;
