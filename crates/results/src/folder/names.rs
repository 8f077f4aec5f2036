//! Names of numbered files in the folder of a run.

use std::path::{Path, PathBuf};

use dem_io::body::stored_walls::FIXED_WALLS_FILE;

pub(super) const FRAMES: &str = "frames";

/// Frame `number` of the results folder `path`.
pub fn frame_in(path: &Path, number: usize) -> PathBuf {
    path.join(frame_name(number))
}

/// The walls of frame `number` of the results folder `path`; [`dem_io::body::read_walls`] reads
/// them. There is no such file if the scene has no walls.
pub fn walls_in(path: &Path, number: usize) -> PathBuf {
    path.join(walls_name(number))
}

/// The name of a frame in the folder, with `/` on every system, as required by ParaView.
pub(crate) fn frame_name(number: usize) -> String {
    format!("{FRAMES}/frame_{number:06}.vtp")
}

/// The name of the walls of a frame in the folder.
pub(crate) fn walls_name(number: usize) -> String {
    format!("{FRAMES}/walls_{number:06}.vtp")
}

/// The name of the walls that never move in the folder.
pub(crate) fn fixed_walls_name() -> String {
    format!("{FRAMES}/{FIXED_WALLS_FILE}")
}

/// 123 of `frame_000123.vtp`.
pub(super) fn frame_number(name: &str) -> Option<usize> {
    number_of(name, "frame_", ".vtp", 6)
}

/// 123 of `walls_000123.vtp`.
pub(super) fn walls_number(name: &str) -> Option<usize> {
    number_of(name, "walls_", ".vtp", 6)
}

/// 123 of `picture-00123.png`.
pub(super) fn picture_number(name: &str) -> Option<usize> {
    number_of(name, "picture-", ".png", 5)
}

/// The number, of at least `least` digits, between `before` and `after`.
fn number_of(name: &str, before: &str, after: &str, least: usize) -> Option<usize> {
    let digits = name.strip_prefix(before)?.strip_suffix(after)?;
    let is_number = digits.len() >= least && digits.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| digits.parse().ok()).flatten()
}
