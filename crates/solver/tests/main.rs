//! The tests of the program.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    clippy::print_stdout,
    reason = "a test stops where it fails, and says what it measured"
)]

mod fragments;
mod helpers;
mod program;
