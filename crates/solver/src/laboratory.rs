//! Laboratory tests: `[test]` of a scene. `arrange` sets the loading rate or the bars or the
//! weight, [`record`] records force and displacement during loading, [`evaluate`] compares them
//! with [`theory`](dem_laboratory::theory), and [`dynamic`] does so for bars and weights, [`files`]
//! writes the results; `watch` connects these to a run.

pub(crate) mod arrange;
pub mod confined;
pub mod crack;
pub mod curve;
pub mod disc_stress;
pub mod dynamic;
pub mod evaluate;
pub mod figure;
pub mod files;
pub mod pieces;
pub mod record;
mod text;
pub(crate) mod watch;
