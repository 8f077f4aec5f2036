//! Removes files that a run has written, and nothing else.

use std::fs;

use super::disk::{entries, refuse_unless_empty};
use super::lock::LOCK;
use super::names::{
    CHECKPOINT, ENDED, FILM, FILM_STRIP, FRAMES, INDEX, PICTURES, PLOTS, SCENE, SINGLE_FILES,
    SUMMARY, WALL_LOAD_INDEX, number_in_frames, picture_number,
};
use super::paths::ResultsFolder;
use super::write::is_scene_as_run;
use crate::plot_file::is_plot_file;
use dem_io::body::stored_walls::FIXED_WALLS_FILE;
use dem_io::diagnostic::Result;
use dem_io::safe_write::{UNFINISHED_PREFIX, explain, remove_if_abandoned};

impl ResultsFolder {
    /// Removes the files written by a run, and the folder unless it contains something else.
    pub fn remove(self) -> Result<()> {
        self.remove_results()?;
        for part in [FRAMES, PICTURES, PLOTS] {
            // A folder with other contents stays, and so does the main folder then.
            let _ = fs::remove_dir(self.path.join(part));
        }
        let is_empty = refuse_unless_empty(&self.path).is_ok();
        let lock = self.path.join(LOCK);
        fs::remove_file(&lock).map_err(|error| explain(&lock, &error))?;
        if is_empty {
            fs::remove_dir(&self.path).map_err(|error| explain(&self.path, &error))?;
        }
        Ok(())
    }

    /// Removes what is neither a table nor the summary, the page or the scene of a run that has
    /// ended: frames, pictures, plots and checkpoint.
    pub fn keep_tables(&self) -> Result<()> {
        // First, so that a partly removed folder is not taken for a run to continue.
        self.remove_files("", |name| name == CHECKPOINT)?;
        self.remove_files("", |name| {
            [ENDED, INDEX, WALL_LOAD_INDEX, FILM, FILM_STRIP].contains(&name)
        })?;
        self.remove_numbered_and_plots()?;
        for part in [FRAMES, PICTURES, PLOTS] {
            // One that holds other files stays.
            let _ = fs::remove_dir(self.path.join(part));
        }
        Ok(())
    }

    /// Removes frame `number` and all after it, with their walls and loads; if it is the first, also
    /// the walls that never move.
    pub(crate) fn remove_frames_from(&self, number: usize) -> Result<()> {
        self.remove_files(FRAMES, |name| {
            number_in_frames(name).is_some_and(|found| found >= number)
                || (number == 0 && name == FIXED_WALLS_FILE)
        })
    }

    /// Removes picture `number` and all after it.
    pub(crate) fn remove_pictures_from(&self, number: usize) -> Result<()> {
        self.remove_files(PICTURES, |name| {
            picture_number(name).is_some_and(|found| found >= number)
        })
    }

    /// Removes the lists of all frames and of the loads of walls, if they are there.
    pub(crate) fn remove_frames_index(&self) -> Result<()> {
        self.remove_files("", |name| [INDEX, WALL_LOAD_INDEX].contains(&name))
    }

    pub(super) fn remove_results(&self) -> Result<()> {
        // First, so that a partly removed folder is not taken for a run to continue.
        self.remove_files("", |name| name == CHECKPOINT)?;
        // Nor for a whole one.
        self.remove_files("", |name| name == SUMMARY)?;
        self.remove_files("", |name| SINGLE_FILES.contains(&name))?;
        let is_ours = is_scene_as_run(&self.file(SCENE));
        self.remove_files("", |name| name == SCENE && is_ours)?;
        self.remove_numbered_and_plots()
    }

    fn remove_numbered_and_plots(&self) -> Result<()> {
        self.remove_frames_from(0)?;
        self.remove_pictures_from(0)?;
        let plots = self.path.join(PLOTS);
        self.remove_files(PLOTS, |name| {
            name.ends_with(".svg") && is_plot_file(&plots.join(name))
        })
    }

    /// Removes the files of the folder `part` that are `ours` by their name. A file left by a
    /// killed write is also ours.
    pub(super) fn remove_files(&self, part: &str, ours: impl Fn(&str) -> bool) -> Result<()> {
        let folder = self.path.join(part);
        if !folder.is_dir() {
            return Ok(());
        }
        for entry in entries(&folder)? {
            let path = entry.map_err(|error| explain(&folder, &error))?;
            let name = path.file_name().and_then(|name| name.to_str());
            let name = name.unwrap_or_default();
            let removed = if name.starts_with(UNFINISHED_PREFIX) {
                remove_if_abandoned(&path)
            } else if ours(name)
                && fs::symlink_metadata(&path).is_ok_and(|metadata| metadata.is_file())
            {
                fs::remove_file(&path)
            } else {
                Ok(())
            };
            removed.map_err(|error| explain(&path, &error))?;
        }
        Ok(())
    }
}
