//! tests/verification/thesis.md: the tests of Platzer 2022 on its two samples, and its results
//! beside ours. Each command but `page` computes its cases on one thread and writes a file for
//! each; cases whose file is there are not computed again. `page` writes tables and plots from the
//! files that are there; what has not been computed anew stays as it stands.

pub(crate) mod bending;
pub(crate) mod drops;
mod map;
pub(crate) mod oscillation;
pub(crate) mod page;
mod plots;
pub(crate) mod rebound;
pub(crate) mod samples;
pub(crate) mod steps;
pub(crate) mod strengthening;
#[cfg(test)]
mod tests;
mod watch;
