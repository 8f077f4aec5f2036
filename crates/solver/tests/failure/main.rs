//! Bonds break where they should, when they should, and leave nothing behind.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]

mod after;
mod bodies;
mod books;
mod loads;
mod rate;
mod scatter;
