//! The tests of the laws and shapes, one module per subject.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    clippy::print_stdout,
    reason = "a test stops where it fails, and says what it measured"
)]

mod bending;
mod bond;
mod contact;
mod machine;
mod shape;
