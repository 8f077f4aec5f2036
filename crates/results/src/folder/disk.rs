//! Folders on the disk.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::lock::LOCK;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::explain;

/// Makes a folder, with those that it is in, unless it exists.
pub fn make_folder(path: &Path) -> Result<()> {
    if let Some(parent) = path.parent().filter(|parent| !parent.exists()) {
        fs::create_dir_all(parent).map_err(|error| explain(parent, &error))?;
    }
    match fs::create_dir(path) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            if path.is_dir() {
                return Ok(());
            }
            Err(Diagnostic::failed(
                path.display().to_string(),
                "this is a file, where a folder is needed",
                "remove it, or write elsewhere",
            ))
        }
        Err(error) => Err(explain(path, &error)),
    }
}

pub(super) fn refuse_unless_empty(folder: &Path) -> Result<()> {
    for path in entries(folder)? {
        let path = path.map_err(|error| explain(folder, &error))?;
        if path.file_name().is_none_or(|name| name != LOCK) {
            return Err(Diagnostic::input(
                folder.display().to_string(),
                "this folder is not empty",
                "write to another one, replace its results with --force, or continue its run with --resume",
            ));
        }
    }
    Ok(())
}

pub(super) fn entries(folder: &Path) -> Result<impl Iterator<Item = std::io::Result<PathBuf>>> {
    let entries = fs::read_dir(folder).map_err(|error| {
        Diagnostic::failed(
            folder.display().to_string(),
            format!("this folder cannot be read: {error}"),
            "write elsewhere",
        )
    })?;
    Ok(entries.map(|entry| entry.map(|entry| entry.path())))
}
