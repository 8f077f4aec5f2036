//! Tests of the page of a run.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod made_run;
mod page;
mod picture;
mod reader;
mod view;
