//! All that can be tested of this crate from outside.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod area;
mod doubts;
mod drop_weight;
mod drop_weight_sheets;
mod failure_line;
mod files;
mod logistic;
mod student;
mod synthetic;
mod theory;
