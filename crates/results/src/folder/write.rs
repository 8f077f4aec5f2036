//! Single files that a run writes as text: the scene as it was run, tables of a test, plots.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use super::disk::make_folder;
use super::names::{PLOTS, SCENE};
use super::paths::ResultsFolder;
use crate::plot_file::write_plot_file;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::write_file;

/// The beginning of a scene that a run has written, so that other files are not removed.
const SCENE_BEGIN: &str = "# Written by dem-run";

impl ResultsFolder {
    /// Writes the scene as it is run to `scene.toml`, after a line that says so. Replaces that of
    /// an earlier run, and refuses to replace any other.
    pub fn write_scene(&self, program: &str, text: &str) -> Result<()> {
        self.refuse_foreign_scene()?;
        write_file(&self.file(SCENE), |out| {
            writeln!(
                out,
                "{SCENE_BEGIN} ({program}): the scene of this run, with all files and settings that it was given."
            )?;
            out.write_all(text.as_bytes())
        })
    }

    /// Refuses a folder with a `scene.toml` that no run has written: it would be lost.
    pub(super) fn refuse_foreign_scene(&self) -> Result<()> {
        let path = self.file(SCENE);
        if !path.exists() || is_scene_as_run(&path) {
            return Ok(());
        }
        Err(Diagnostic::input(
            path.display().to_string(),
            "the scene of the run would take the place of this file",
            "rename it, or name another folder with --output",
        ))
    }

    /// Writes the text of a file of which a run writes one, replacing an earlier one.
    pub fn write(&self, name: &str, text: &str) -> Result<()> {
        write_file(&self.file(name), |out| out.write_all(text.as_bytes()))
    }

    /// Writes a plot to `plots/NAME.svg`, replacing an earlier one. `svg`: the text of an SVG file.
    pub fn write_plot(&self, name: &str, svg: &str) -> Result<()> {
        make_folder(&self.path.join(PLOTS))?;
        write_plot_file(&self.plot(name), svg)
    }
}

/// True if a run has written the scene in this file.
pub(super) fn is_scene_as_run(path: &Path) -> bool {
    let mut begin = [0; SCENE_BEGIN.len()];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut begin));
    read.is_ok() && begin == SCENE_BEGIN.as_bytes()
}
