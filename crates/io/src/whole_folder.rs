//! Folders that appear with all their files or not at all: filled under a temporary name beside
//! their own, then renamed.

use std::env;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::diagnostic::{Diagnostic, Result};
use crate::safe_write::{UNFINISHED_PREFIX, explain};

/// A folder that a command fills. If it is dropped without [`WholeFolder::publish`], it is removed.
#[derive(Debug)]
pub struct WholeFolder {
    target: PathBuf,
    temporary: PathBuf,
    is_there: bool,
    /// Locked as long as the command fills it.
    _lock: Option<File>,
}

impl WholeFolder {
    /// Makes the temporary folder and those that it is in, and removes those of commands that were
    /// killed. `target`: the later folder, new or empty. `option`: what names it, for messages.
    pub fn beside(target: &Path, option: &str) -> Result<Self> {
        refuse_filled(target, option)?;
        let failed = |error: io::Error| explain(target, &error);
        let whole = if target.exists() {
            fs::canonicalize(target)
        } else {
            std::path::absolute(target)
        };
        let whole = whole.map_err(failed)?;
        if let Some(parent) = whole.parent() {
            fs::create_dir_all(parent).map_err(|error| no_parent(target, &error))?;
        }
        remove_abandoned(&whole);
        let mut number = 0;
        let temporary = loop {
            let name = format!("{UNFINISHED_PREFIX}{}-{number}", std::process::id());
            let temporary = whole.with_file_name(name);
            match fs::create_dir(&temporary) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
                made => break made.map(|()| temporary),
            }
        }
        .map_err(failed)?;
        let lock = File::open(&temporary).ok();
        Ok(Self {
            target: whole,
            temporary,
            is_there: true,
            _lock: lock.filter(|folder| folder.try_lock().is_ok()),
        })
    }

    /// Where its files are written.
    pub fn path(&self) -> &Path {
        &self.temporary
    }

    /// All its files are there: it gets its name. Refuses a folder that has been filled meanwhile.
    pub fn publish(mut self) -> Result<()> {
        let is_in_use = env::current_dir().is_ok_and(|current| current.starts_with(&self.target));
        let published = if is_in_use {
            move_files(&self.temporary, &self.target)
        } else {
            fs::rename(&self.temporary, &self.target)
        };
        published.map_err(|error| explain(&self.target, &error))?;
        self.is_there = is_in_use;
        Ok(())
    }
}

/// Refuses what is no folder, or one with files in it.
fn refuse_filled(target: &Path, option: &str) -> Result<()> {
    if fs::symlink_metadata(target).is_err() {
        return Ok(());
    }
    let problem = match fs::read_dir(target).map(|mut entries| entries.next().is_none()) {
        Ok(true) => return Ok(()),
        Ok(false) => "this folder is not empty",
        Err(_) => "this is not a folder that can be read",
    };
    Err(Diagnostic::input(
        target.display().to_string(),
        problem,
        format!("name a new folder with {option}"),
    ))
}

/// Why the folder in which the new one is made cannot be made.
fn no_parent(folder: &Path, error: &io::Error) -> Diagnostic {
    match error.kind() {
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => Diagnostic::input(
            folder.display().to_string(),
            "a part of this path is a file, not a folder",
            "name another folder",
        ),
        _ => explain(folder, error),
    }
}

/// Moves all files of a folder into another one.
fn move_files(from: &Path, to: &Path) -> io::Result<()> {
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        fs::rename(entry.path(), to.join(entry.file_name()))?;
    }
    Ok(())
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
