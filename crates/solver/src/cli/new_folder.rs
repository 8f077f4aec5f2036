//! A folder that a command fills: new or empty, and gone again if the command fails; or one that
//! appears with all its files or not at all.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use dem_io::safe_write::{UNFINISHED_PREFIX, explain};
use dem_io::{Diagnostic, Result};

/// A folder that was made, or was there and empty. Dropped before [`NewFolder::keep`], one that was
/// made is removed if it is still empty.
#[derive(Debug)]
pub(super) struct NewFolder {
    path: PathBuf,
    is_made: bool,
}

impl NewFolder {
    /// Makes a folder, with those that it is in, or takes an empty one. `option`: the option that
    /// names it.
    pub(super) fn make(path: &Path, option: &str) -> Result<Self> {
        let refused = |problem: &str| {
            let place = path.display().to_string();
            let remedy = format!("name a new folder with {option}");
            Err(Diagnostic::input(place, problem, remedy))
        };
        let is_made = !path.exists();
        if is_made {
            fs::create_dir_all(path).map_err(|error| dem_io::safe_write::explain(path, &error))?;
        } else {
            match fs::read_dir(path).map(|mut entries| entries.next().is_none()) {
                Ok(true) => {}
                Ok(false) => return refused("this folder is not empty"),
                Err(_) => return refused("this is not a folder that can be read"),
            }
        }
        Ok(Self {
            path: path.to_owned(),
            is_made,
        })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// All its files are there.
    pub(super) fn keep(mut self) {
        self.is_made = false;
    }
}

impl Drop for NewFolder {
    fn drop(&mut self) {
        if self.is_made {
            // The user must see the problem itself.
            let _ = fs::remove_dir(&self.path);
        }
    }
}

/// A folder that is filled under a temporary name beside its own, and then renamed: killed on the
/// way, a command leaves no half of it under its name.
#[derive(Debug)]
pub(crate) struct WholeFolder {
    target: PathBuf,
    temporary: PathBuf,
    is_there: bool,
    /// Locked as long as the command fills it.
    _lock: Option<File>,
}

impl WholeFolder {
    /// Makes the temporary folder, and removes those of commands that were killed. `target`: the
    /// later folder, which does not exist yet.
    pub(crate) fn beside(target: &Path) -> io::Result<Self> {
        remove_abandoned(target);
        let mut number = 0;
        let temporary = loop {
            let name = format!("{UNFINISHED_PREFIX}{}-{number}", std::process::id());
            let temporary = target.with_file_name(name);
            match fs::create_dir(&temporary) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
                made => break made.map(|()| temporary),
            }
        }?;
        let lock = File::open(&temporary).ok();
        Ok(Self {
            target: target.to_owned(),
            temporary,
            is_there: true,
            _lock: lock.filter(|folder| folder.try_lock().is_ok()),
        })
    }

    /// Where its files are written.
    pub(crate) fn path(&self) -> &Path {
        &self.temporary
    }

    /// All its files are there: it gets its name. Refuses a folder that has appeared there
    /// meanwhile and is not empty.
    pub(crate) fn publish(mut self) -> Result<()> {
        fs::rename(&self.temporary, &self.target).map_err(|error| explain(&self.target, &error))?;
        self.is_there = false;
        Ok(())
    }
}

/// Removes the temporary folders beside a path whose commands do not run any more. Another command
/// has not locked its own yet while that is empty: such a folder stays.
fn remove_abandoned(target: &Path) {
    let beside = target.with_file_name(".");
    for entry in fs::read_dir(beside).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let rest = name
            .to_str()
            .and_then(|name| name.strip_prefix(UNFINISHED_PREFIX));
        let is_ours = rest.and_then(|rest| rest.split_once('-')).is_some();
        let path = entry.path();
        let is_folder = || fs::symlink_metadata(&path).is_ok_and(|found| found.is_dir());
        let is_filled = || fs::read_dir(&path).is_ok_and(|mut entries| entries.next().is_some());
        if is_ours && is_folder() && is_filled() {
            let folder = File::open(&path).ok();
            if folder.is_some_and(|folder| folder.try_lock().is_ok()) {
                // What cannot be removed does no harm.
                let _ = fs::remove_dir_all(&path);
            }
        }
    }
}

impl Drop for WholeFolder {
    fn drop(&mut self) {
        if self.is_there {
            // The user must see the problem itself.
            let _ = fs::remove_dir_all(&self.temporary);
        }
    }
}
