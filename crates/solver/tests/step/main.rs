//! The time step: limits, ledgers, determinism.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bars;
mod limit;
