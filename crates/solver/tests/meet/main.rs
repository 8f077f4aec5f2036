//! Particles that meet: contacts in the moving solver.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test stops where it fails, and says what it measured"
)]

mod apart;
#[path = "../walls/closed_box.rs"]
mod closed_box;
mod clouds;
mod rest;
mod surfaces;
mod walls;
