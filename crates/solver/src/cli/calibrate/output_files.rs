//! The files that a calibration writes, and which others it may replace.

use std::fs::File;
use std::path::{Path, PathBuf};

use dem_io::safe_write::explain;
use dem_io::write_target::{need_folder_of, refuse_to_replace};
use dem_io::{Diagnostic, Result};
use dem_results::folder::lock_file;

/// The lock on the files of a calibration. The system releases it when the program ends for
/// whatever reason; its file is removed when this is dropped.
pub(super) struct Lock {
    path: PathBuf,
    _file: File,
}

impl Drop for Lock {
    fn drop(&mut self) {
        // It does no harm if it stays.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Whether an open file still has its name.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let there = std::fs::metadata(path).ok();
    let both = file.metadata().ok().zip(there);
    both.is_some_and(|(a, b)| (a.dev(), a.ino()) == (b.dev(), b.ino()))
}

/// Elsewhere an open file cannot be removed.
#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

/// The material file of a calibration that has not met its targets.
pub(super) fn not_met(material: &Path) -> PathBuf {
    let stem = material.file_stem().unwrap_or_default().to_string_lossy();
    material.with_file_name(format!("{stem}-not-met.toml"))
}

/// The files that a calibration writes.
pub(super) struct OutputFiles {
    /// The material file of each size.
    pub(super) materials: Vec<PathBuf>,
    pub(super) page: PathBuf,
    pub(super) record: PathBuf,
}

impl OutputFiles {
    /// For a number of sizes: the material files are numbered if there are several.
    pub(super) fn of(output: &Path, sizes: usize) -> Result<Self> {
        let [page, record] = ["html", "json"].map(|ending| output.with_extension(ending));
        if page == output || record == output || output.is_dir() {
            let problem = format!(
                "{} is a folder, or the name of the page or the record",
                output.display()
            );
            let remedy = "write the material to a name that ends in .toml";
            return Err(Diagnostic::input("--output", problem, remedy));
        }
        need_folder_of(output)?;
        let stem = output.file_stem().unwrap_or_default().to_string_lossy();
        let numbered = |number: usize| output.with_file_name(format!("{stem}-{number}.toml"));
        let materials = match sizes {
            1 => vec![output.to_owned()],
            _ => (1..=sizes).map(numbered).collect(),
        };
        Ok(Self {
            materials,
            page,
            record,
        })
    }

    /// Keeps other calibrations from writing the same files as long as the lock lives.
    pub(super) fn lock(&self) -> Result<Lock> {
        let name = self.record.file_name().unwrap_or_default();
        let path = self
            .record
            .with_file_name(format!(".{}.lock", name.to_string_lossy()));
        loop {
            let file = lock_file(&path).map_err(|error| explain(&path, &error))?;
            let file = file.ok_or_else(|| {
                Diagnostic::input(
                    self.record.display().to_string(),
                    "another calibration is writing it",
                    "wait until that has ended, or write to another --output",
                )
            })?;
            // One that has ended meanwhile may have removed this file, and a third made another.
            if is_at(&file, &path) {
                return Ok(Lock { path, _file: file });
            }
        }
    }

    fn all(&self) -> Vec<PathBuf> {
        let others = [self.page.clone(), self.record.clone()];
        let materials = self
            .materials
            .iter()
            .flat_map(|path| [path.clone(), not_met(path)]);
        materials.chain(others).collect()
    }

    /// Refuses to overwrite inputs, and other files unless a calibration is resumed or replaced.
    pub(super) fn refuse(&self, inputs: &[PathBuf], [resumes, replaces]: [bool; 2]) -> Result<()> {
        refuse_to_replace(&self.all(), inputs)?;
        let there: Vec<PathBuf> = self
            .all()
            .into_iter()
            .filter(|file| file.exists())
            .collect();
        if resumes && self.record.exists() {
            return Ok(());
        }
        if let (Some(file), false) = (there.last(), replaces) {
            let (problem, remedy) = if *file == self.record {
                (
                    "there is a calibration already",
                    "go on with it by --resume, replace it by --force, or write to another --output",
                )
            } else {
                (
                    "there is a file of this name already",
                    "replace it by --force, or write to another --output",
                )
            };
            return Err(Diagnostic::input(
                file.display().to_string(),
                problem,
                remedy,
            ));
        }
        Ok(())
    }

    /// Removes an earlier calibration: after a failure it would be taken for the new result.
    pub(super) fn remove(&self) -> Result<()> {
        for file in self.all().into_iter().filter(|file| file.exists()) {
            std::fs::remove_file(&file).map_err(|error| explain(&file, &error))?;
        }
        Ok(())
    }
}
