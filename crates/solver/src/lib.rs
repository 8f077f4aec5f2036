//! Runs scenes with bonded bodies: TOML scene -> [`plan`] -> [`state`] -> [`step`], step, ... ->
//! results.

pub mod check;
pub mod cli;
pub mod clock;
mod disjoint;
pub mod geometry;
pub mod interpolation;
pub mod interrupt;
pub mod laboratory;
pub mod machine;
pub mod measure;
pub mod output;
pub mod physics;
pub mod plan;
pub mod run;
pub mod shape;
pub mod stages;
pub mod state;
pub mod step;
pub mod stress;
pub mod sweep;

/// The code on the page is compiled and run with the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../doc/adding-a-model.md")]
struct AddingAModel;
