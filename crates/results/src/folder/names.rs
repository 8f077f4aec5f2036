//! Names of the files and folders in the folder of a run.

use std::path::{Path, PathBuf};

use dem_io::body::stored_walls::FIXED_WALLS_FILE;

pub(super) const FRAMES: &str = "frames";
pub(super) const PLOTS: &str = "plots";
pub(super) const PICTURES: &str = "pictures";
pub(super) const FILM_STRIP: &str = "film-strip.png";
pub(super) const FILM: &str = "film.png";
pub(super) const INDEX: &str = "frames.pvd";
pub(super) const SERIES: &str = "series.csv";
pub(super) const EVENTS: &str = "events.csv";
pub(super) const FRAGMENTS: &str = "fragments.csv";
pub(super) const FRAGMENT_TREE: &str = "fragment-tree.csv";
pub(super) const DISCHARGE: &str = "discharge.csv";
pub(super) const DISTRIBUTION: &str = "distribution.csv";
pub(super) const FLOW: &str = "flow.csv";
pub(super) const MIXING: &str = "mixing.csv";
pub(super) const SUMMARY: &str = "summary.json";
pub(super) const REPORT: &str = "report.html";
pub(super) const SCENE: &str = "scene.toml";
pub(super) const TEST_CURVE: &str = "force-displacement.csv";
pub(super) const BAR_SIGNALS: &str = "bar-signals.csv";
pub(super) const GAUGE_SIGNALS: &str = "gauge-signals.csv";
pub(super) const DISC_STRESS: &str = "disc-stress.csv";
pub(super) const CHECKPOINT: &str = "checkpoint.dem";
pub(super) const ENDED: &str = ".ended.json";
/// Files of which a run writes one each.
pub(super) const SINGLE_FILES: [&str; 19] = [
    INDEX,
    SERIES,
    EVENTS,
    FRAGMENTS,
    FRAGMENT_TREE,
    DISCHARGE,
    DISTRIBUTION,
    FLOW,
    MIXING,
    SUMMARY,
    REPORT,
    TEST_CURVE,
    BAR_SIGNALS,
    GAUGE_SIGNALS,
    DISC_STRESS,
    FILM_STRIP,
    FILM,
    CHECKPOINT,
    ENDED,
];

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
