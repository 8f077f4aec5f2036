//! Ledgers of energy and momentum.

pub mod balance;
pub(crate) mod islands;
mod rounding;
pub mod totals;
