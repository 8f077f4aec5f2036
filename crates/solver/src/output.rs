//! What a run tells: frames, time series, events, plots, and the summary at its end.

pub mod frames;
pub mod plots;
pub mod series;
pub mod summary;
