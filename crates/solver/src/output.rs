//! Output of a run: frames, pictures, time series, events, fragments, plots, and the summary at its
//! end.

pub mod equilibrium;
pub mod fragments;
pub mod frames;
pub mod pictures;
pub mod plots;
pub mod series;
pub mod summary;
