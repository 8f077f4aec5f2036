//! Any bytes given to the STL reader.
#![no_main]

#[path = "../../crates/io/tests/fuzz_bodies/read_stl.rs"]
mod body;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| body::read_stl(bytes));
