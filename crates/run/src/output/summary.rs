//! The summary of a run: its results, their reliability, and the time spent in each stage.

mod contents;
mod parts;
mod text;

pub use contents::{Summary, Unfinished, Verdict};
pub use parts::{AdaptiveSummary, PartError, PopulationSummary, SleepSummary, TakenIn};
