//! Helpers shared by tests of several crates.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]

pub mod made_test;
mod messages;
mod random;
mod table;

pub use messages::hold_messages;
pub use random::Random;
pub use table::hold_table;

use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Names of the entries of a folder, including hidden files, sorted.
pub fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Runs a program with `input` on its standard input.
pub fn piped(program: &mut Command, input: &[u8]) -> Output {
    let mut child = program
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    std::thread::scope(|scope| {
        // A program that refuses its input early closes it.
        scope.spawn(move || stdin.write_all(input));
        child.wait_with_output().unwrap()
    })
}

/// Runs a program once with a standard error that is full, and once with one whose reader is gone.
/// Returns the exit codes.
#[cfg(target_os = "linux")]
pub fn codes_without_standard_error(program: &mut Command) -> [Option<i32>; 2] {
    let full = std::fs::File::options().write(true).open("/dev/full");
    let (reader, closed) = std::io::pipe().unwrap();
    drop(reader);
    [full.unwrap().into(), Stdio::from(closed)]
        .map(|stderr| program.stderr(stderr).status().unwrap().code())
}
