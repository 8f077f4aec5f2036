//! End-to-end tests of the two programs live in `tests/tests`; this is what they share.

#![allow(clippy::unwrap_used, clippy::panic, reason = "this crate holds tests")]

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;
use std::sync::{Mutex, PoisonError};

/// One of the programs, built in the profile of the test that runs: cargo builds no binaries for
/// tests of another package.
pub fn program(name: &str) -> Command {
    static BUILT: Mutex<BTreeMap<String, PathBuf>> = Mutex::new(BTreeMap::new());
    let mut built = BUILT.lock().unwrap_or_else(PoisonError::into_inner);
    let path = built.entry(name.to_owned()).or_insert_with(|| build(name));
    Command::new(path)
}

/// Runs a program once with a standard error that is full, and once with one whose reader is gone;
/// the exit codes.
#[cfg(target_os = "linux")]
pub fn codes_without_standard_error(command: &mut Command) -> [Option<i32>; 2] {
    let full = std::fs::File::options().write(true).open("/dev/full");
    let (reader, closed) = std::io::pipe().unwrap();
    drop(reader);
    [full.unwrap().into(), std::process::Stdio::from(closed)]
        .map(|stderr| command.stderr(stderr).status().unwrap().code())
}

fn build(name: &str) -> PathBuf {
    let profile = if cfg!(debug_assertions) {
        "test"
    } else {
        "release"
    };
    let this_test = std::env::current_exe().unwrap();
    // target/release/deps/this-test
    let built = this_test.ancestors().nth(2).unwrap();
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args([
        "build",
        "--quiet",
        "--package",
        name,
        "--bin",
        name,
        "--profile",
        profile,
    ]);
    cargo
        .arg("--target-dir")
        .arg(built.parent().unwrap())
        .current_dir(env!("CARGO_MANIFEST_DIR"));
    assert!(cargo.status().unwrap().success(), "{name} cannot be built");
    built
        .join(name)
        .with_extension(std::env::consts::EXE_EXTENSION)
}
