//! Bodies through every file format, and damaged, foreign and hostile files.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "body_files/bodies.rs"]
mod bodies;
#[path = "body_files/damaged.rs"]
mod damaged;
#[path = "body_files/endless.rs"]
mod endless;
#[path = "body_files/every_reader.rs"]
mod every_reader;
#[path = "body_files/foreign.rs"]
mod foreign;
#[path = "body_files/names.rs"]
mod names;
#[path = "body_files/round_trip.rs"]
mod round_trip;
