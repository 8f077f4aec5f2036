//! A sweep: a scene is run with many settings, each in a process of its own, to see the response of
//! a measure, or to compare error with run time.
//!
//! Study -> [`expand`] runs, with [`packings`] of their own -> [`jobs`] processes with a folder each
//! -> [`collect`] their outcomes -> [`response`]s; `judge` errors (of distributions: [`masses`], of
//! tests: [`curves`]) -> `table` medians, `front`s, `order`s -> CSV, JSON, [`page`] with [`plot`]s
//! and [`response_plot`]s, [`want`] the fastest run that is accurate enough. [`search`] adds points
//! to the study until the value that is looked for is found. A [`design`] moves parameters within
//! ranges ([`morris`], [`one_at_a_time`]); the [`ranking`] shows what each of them changes. The
//! [`probability`] of an outcome is a curve over a parameter.

mod chance;
pub mod cluster;
pub mod collect;
pub(crate) mod csv_line;
pub mod curves;
pub mod design;
pub mod expand;
mod failure_line;
pub mod folder;
pub(crate) mod front;
pub mod increase_table;
pub mod jobs;
pub(crate) mod judge;
pub mod masses;
pub(crate) mod median;
pub mod morris;
pub mod one_at_a_time;
pub(crate) mod order;
pub mod outcome;
pub mod packings;
pub mod page;
pub mod plot;
pub mod probability;
pub mod probability_page;
pub mod ranking;
pub(crate) mod ranking_page;
pub mod ranking_plot;
pub mod ranking_text;
pub(crate) mod reference;
pub mod response;
pub(crate) mod response_page;
pub mod response_plot;
pub mod row;
pub mod search;
pub mod sweep_table;
pub(crate) mod table;
pub mod text;
pub mod want;
pub(crate) mod words;
