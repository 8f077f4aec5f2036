//! A sweep: a scene is run with many settings, each in a process of its own, to compare error with
//! run time.
//!
//! Study -> [`expand`] runs -> [`jobs`] processes with a folder each -> [`collect`] their
//! outcomes -> `judge` errors (of distributions: [`masses`], of tests: [`curves`]) -> `table`
//! medians, `front`s, `order`s -> CSV, JSON, [`page`] with [`plot`]s, [`want`] the fastest run
//! that is accurate enough.

pub mod collect;
pub mod curves;
pub mod expand;
pub mod folder;
pub(crate) mod front;
pub mod jobs;
pub(crate) mod judge;
pub mod masses;
pub(crate) mod order;
pub mod outcome;
pub mod page;
pub mod plot;
pub(crate) mod reference;
pub mod rows;
pub(crate) mod table;
pub mod text;
pub mod want;
