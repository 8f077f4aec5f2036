//! `dem-run version-info`: the program and the formats that it reads and writes.

use dem_io::Result;
use dem_results::checkpoint::FORMAT_VERSION;
use dem_scene::SCENE_VERSION;
use dem_terminal::standard_output::write_standard_output;

/// Prints the versions of the program, of scenes and of checkpoints.
pub(super) fn print_versions() -> Result<()> {
    write_standard_output(|out| {
        writeln!(out, "dem-run {}", env!("CARGO_PKG_VERSION"))?;
        writeln!(out, "scenes {SCENE_VERSION}")?;
        writeln!(out, "checkpoints {FORMAT_VERSION}")
    })
}
