//! Quasi-static laboratory tests: `[test]` of a scene. `arrange` sets the loading rate,
//! [`record`] records force and displacement during loading, [`evaluate`] compares them with
//! [`theory`](dem_laboratory::theory), [`files`] writes the results; `watch` connects these to
//! a run.

pub(crate) mod arrange;
pub mod crack;
pub mod evaluate;
pub mod files;
pub mod record;
mod text;
pub(crate) mod watch;
