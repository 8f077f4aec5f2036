//! Bond laws against closed forms, reference values and their own energy.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]

mod damping;
mod failure;
mod incremental;
mod pair;
mod scatter;
mod stiffness;
mod strain_rate;
mod total;
