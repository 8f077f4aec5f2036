//! The moving solver: largest steps, energy and momentum, frequencies, equal results.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stderr,
    reason = "a test stops where it fails, and says what it measured"
)]

mod bars;
mod breakage;
mod energy;
mod frequencies;
mod ledger;
mod limit;
mod lowest_frequency;
mod neighbours;
mod rigid;
mod threads;
mod watchdog;
mod waves;
