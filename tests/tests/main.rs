//! Both programs together, the README, the shapes of the repository, and the pages of verification.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test stops where it fails"
)]

mod allocations;
mod notation;
mod pipe;
#[cfg(unix)]
mod readme;
mod rocks;
mod shapes;
mod structure;
mod verification;

use std::path::{Path, PathBuf};
use std::process::Command;

const DEM_PACK: &str = env!("CARGO_BIN_EXE_dem-pack-for-tests");
const DEM_RUN: &str = env!("CARGO_BIN_EXE_dem-run-for-tests");

fn dem_pack() -> Command {
    Command::new(DEM_PACK)
}

fn dem_run() -> Command {
    Command::new(DEM_RUN)
}

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}
