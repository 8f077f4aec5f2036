//! Makes the folder of a run, or takes an existing one.

use std::path::Path;
use std::sync::Arc;

use super::disk::{make_folder, refuse_unless_empty};
use super::lock::{LOCK, lock};
use super::names::{FRAMES, PICTURES, PLOTS, SUMMARY};
use super::paths::ResultsFolder;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::PendingFile;

/// Treatment of a folder that is not empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Refuse it.
    Refuse,
    /// Remove the files written by an earlier run, and nothing else: `--force`.
    Replace,
    /// Leave everything except the remains of killed writes, to continue a run: `--resume`.
    Continue,
}

impl ResultsFolder {
    /// Makes the folder `path`, with those that it is in, or uses the existing one, and checks that
    /// it can be written to.
    ///
    /// # Errors
    /// Not empty, by `existing`; none to continue; in use by another run (all exit code 2).
    pub fn create(path: &Path, existing: Existing) -> Result<Self> {
        if existing != Existing::Continue {
            make_folder(path)?;
        } else if !path.is_dir() {
            return Err(Diagnostic::input(
                path.display().to_string(),
                "there is no such folder, so no run to continue",
                "check its name, or start the run without --resume",
            ));
        }
        // A folder that is not that of a run does not get a lock file either.
        if existing == Existing::Refuse && !path.join(LOCK).exists() {
            refuse_unless_empty(path)?;
        }
        let folder = Self {
            path: path.to_owned(),
            _lock: Arc::new(lock(path)?),
        };
        match existing {
            Existing::Refuse => refuse_unless_empty(path)?,
            Existing::Replace => {
                folder.refuse_foreign_scene()?;
                folder.remove_results()?;
            }
            Existing::Continue => {
                // The remains of a killed write.
                for part in ["", FRAMES, PICTURES, PLOTS] {
                    folder.remove_files(part, |_| false)?;
                }
            }
        }
        // This file is not kept: it only shows that files can be written here.
        PendingFile::write(&folder.file(SUMMARY), |_| Ok(()))?;
        Ok(folder)
    }

    /// Makes the folder of the frames, unless it is there.
    pub(crate) fn make_frames_folder(&self) -> Result<()> {
        make_folder(&self.path.join(FRAMES))
    }

    /// Makes the folder of the pictures, unless it is there.
    pub(crate) fn make_pictures_folder(&self) -> Result<()> {
        make_folder(&self.path.join(PICTURES))
    }
}
