//! A sweep: a scene is run with many settings, each in a process of its own; error against run time
//! comes of it.
//!
//! Study -> [`expand`] runs -> [`jobs`] processes with a folder each -> [`collect`] what they came
//! to -> [`judge`] errors (of distributions: [`masses`], of tests: [`curves`]) -> [`table`]
//! medians, [`front`]s, [`order`]s -> CSV, JSON, [`page`] with [`plot`]s, [`want`] the fastest that
//! is exact enough.

pub mod collect;
pub mod curves;
pub mod expand;
pub mod folder;
pub mod front;
pub mod jobs;
pub mod judge;
pub mod masses;
pub mod order;
pub mod outcome;
pub mod page;
pub mod plot;
pub mod reference;
pub mod rows;
pub mod table;
pub mod text;
pub mod want;
