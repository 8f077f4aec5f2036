//! Ledgers of energy and momentum.

pub mod bookkeeping;
pub(crate) mod islands;
mod rounding;
pub mod totals;
