//! Quasi-static laboratory tests: `[test]` of a scene. [`arrange`] says how fast what moves,
//! [`record`] notes force and way while it is loaded, [`evaluate`] compares them with
//! [`theory`](crate::plan::test_theory), [`page`] shows it; [`watch`] does so for a run.

pub mod arrange;
pub mod crack;
pub mod evaluate;
pub mod page;
pub mod record;
mod text;
pub mod watch;
