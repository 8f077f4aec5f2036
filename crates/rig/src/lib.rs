//! Laboratory tests: `[test]` of a scene. `arrange` sets the loading rate or the bars or the
//! weight, [`record`] records force and displacement during loading, [`evaluate`] compares them
//! with [`theory`](dem_laboratory::theory), and [`dynamic`] does so for bars and weights, [`files`]
//! writes the results; `watch` connects these to a run.

pub mod arrange;
pub mod confined;
pub mod crack;
pub mod curve;
pub mod disc_stress;
pub mod dynamic;
pub mod elastic_test;
pub mod evaluate;
pub mod files;
pub mod pieces;
mod planned;
pub mod press;
pub mod record;
mod seat;
pub mod setup;
pub mod watch;

pub use planned::plan_with_test;
