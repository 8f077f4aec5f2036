//! Bodies in every file format, and damaged, foreign and hostile files.

mod bodies;
mod damaged;
mod endless;
mod every_reader;
mod foreign;
mod names;
mod round_trip;
