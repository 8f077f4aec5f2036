//! Output of a run: frames, pictures, time series, events, fragments, plots, and the summary at its
//! end.

pub mod flows;
pub mod fragments;
pub(crate) mod frames;
pub mod pictures;
pub(crate) mod plots;
pub(crate) mod series;
pub(crate) mod summary;
pub(crate) mod walls;
