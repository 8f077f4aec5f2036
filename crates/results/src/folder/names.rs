//! Names of the files and folders in the folder of a run.

use std::path::{Path, PathBuf};

use dem_io::body::stored_walls::FIXED_WALLS_FILE;

pub(super) const FRAMES: &str = "frames";
/// How the names of the loads of walls beside frames begin.
const LOADS: &str = "loads_";
pub(super) const PLOTS: &str = "plots";
pub(super) const PICTURES: &str = "pictures";
/// Some pictures side by side.
pub const FILM_STRIP: &str = "film-strip.png";
/// The pictures one after the other.
pub const FILM: &str = "film.png";
/// The list of all frames with their times, which ParaView opens.
pub const INDEX: &str = "frames.pvd";
/// Time series.
pub const SERIES: &str = "series.csv";
/// Events.
pub const EVENTS: &str = "events.csv";
/// Fragments at chosen moments.
pub const FRAGMENTS: &str = "fragments.csv";
/// The origin of each fragment.
pub const FRAGMENT_TREE: &str = "fragment-tree.csv";
/// What leaves through outlets.
pub const DISCHARGE: &str = "discharge.csv";
/// The size distribution of all fragments.
pub const DISTRIBUTION: &str = "distribution.csv";
/// Mass flows over time.
pub const FLOW: &str = "flow.csv";
/// The cells of mixtures.
pub const MIXING: &str = "mixing.csv";
/// What contacts have done to the patches of walls.
pub const WALL_LOADS: &str = "wall_loads.csv";
/// The same for ParaView.
pub const WALL_LOAD_CELLS: &str = "wall_loads.vtp";
/// The list of the loads of walls at the times of the frames, which ParaView opens.
pub const WALL_LOAD_INDEX: &str = "wall_loads.pvd";
/// Summary.
pub const SUMMARY: &str = "summary.json";
/// The page of the run.
pub const REPORT: &str = "report.html";
/// The scene as it was run.
pub const SCENE: &str = "scene.toml";
/// The curve of a laboratory test.
pub const TEST_CURVE: &str = "force-displacement.csv";
/// The pulses in the bars of a split-Hopkinson test.
pub const BAR_SIGNALS: &str = "bar-signals.csv";
/// What the strain gauges of a split-Hopkinson test record.
pub const GAUGE_SIGNALS: &str = "gauge-signals.csv";
/// The stress over the loaded diameter of a disc.
pub const DISC_STRESS: &str = "disc-stress.csv";
/// The latest state of the run.
pub const CHECKPOINT: &str = "checkpoint.dem";
/// The data written at the end of a run, kept until all files are complete.
pub const ENDED: &str = ".ended.json";
/// Files of which a run writes one each.
pub(super) const SINGLE_FILES: [&str; 22] = [
    INDEX,
    SERIES,
    EVENTS,
    FRAGMENTS,
    FRAGMENT_TREE,
    DISCHARGE,
    DISTRIBUTION,
    FLOW,
    MIXING,
    WALL_LOADS,
    WALL_LOAD_CELLS,
    WALL_LOAD_INDEX,
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

/// The name of the loads of walls at the time of a frame in the folder.
pub(crate) fn loads_name(number: usize) -> String {
    format!("{FRAMES}/{}", loads_file(number))
}

/// `loads_000123.vtp`: the loads of walls beside the frame of this number.
pub fn loads_file(number: usize) -> String {
    format!("{LOADS}{number:06}.vtp")
}

/// The name of the walls that never move in the folder.
pub(crate) fn fixed_walls_name() -> String {
    format!("{FRAMES}/{FIXED_WALLS_FILE}")
}

/// 123 of `frame_000123.vtp`.
pub(super) fn frame_number(name: &str) -> Option<usize> {
    number_of(name, "frame_", ".vtp", 6)
}

/// 123 of `frame_000123.vtp`, and of the walls and loads beside it.
pub(super) fn number_in_frames(name: &str) -> Option<usize> {
    let parts = ["frame_", "walls_", LOADS];
    parts
        .iter()
        .find_map(|part| number_of(name, part, ".vtp", 6))
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
