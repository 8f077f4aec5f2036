//! Any bytes given to the reader of files of triangles.
#![no_main]

#[path = "../../crates/io/tests/fuzz_bodies/read_stl.rs"]
mod body;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| body::read_stl(bytes));
