//! Any bytes through every reader of bodies: `cargo +nightly fuzz run read_body`.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../crates/io/tests/body_files/every_reader.rs"]
mod every_reader;

fuzz_target!(|data: &[u8]| every_reader::every_reader(data));
