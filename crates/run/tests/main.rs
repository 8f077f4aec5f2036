//! The tests of plans, their steps and runs, one module per subject.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    clippy::print_stdout,
    reason = "a test stops where it fails, and says what it measured"
)]

mod bars;
mod closed_box;
mod helpers;

mod bond;
mod bridges;
mod clumps;
mod clusters;
mod contact;
mod failure;
mod fragments;
mod leave_out;
mod machines;
mod measures;
mod meet;
mod pictures;
mod pictures_colours;
mod pictures_scale;
mod sleep;
mod start;
mod statics;
mod step;
mod wall_loads;
mod walls;
mod zones;
