//! Laboratory tests: evaluation, pictures, sections of bonds.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]

mod evaluation;
mod pictures;
mod section;
