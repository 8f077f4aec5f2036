//! Studies with made outcomes: what the tables say is known beforehand.
#![allow(missing_docs, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod errors;
mod expansion;
mod failure_line;
mod fastest;
mod front;
mod increase_table;
mod made;
mod morris;
mod orders;
mod probability;
mod ranking;
mod repeats;
mod responses;
mod search;
mod text;
