//! The lock on the folder of a run: one run at a time writes into it.

use std::fs::{File, TryLockError};
use std::io;
use std::path::Path;

use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::safe_write::explain;

pub(super) const LOCK: &str = ".lock";

/// Locks a folder. The system releases the lock when the program ends for whatever reason. The file
/// stays: another run may be about to lock it.
pub(super) fn lock(folder: &Path) -> Result<File> {
    let path = folder.join(LOCK);
    lock_file(&path)
        .map_err(|error| explain(&path, &error))?
        .ok_or_else(|| {
            Diagnostic::input(
                folder.display().to_string(),
                "another run is writing into it",
                "wait until that run has ended, or name another folder with --output",
            )
        })
}

/// Makes a file where there is none, and locks it. None: another program holds its lock. Some
/// network disks do not support locks; the file is then returned without.
pub fn lock_file(path: &Path) -> io::Result<Option<File>> {
    let mut options = File::options();
    let file = options
        .write(true)
        .create(true)
        .truncate(false)
        .open(path)?;
    let is_held = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
    Ok((!is_held).then_some(file))
}

/// True if a run is writing into the folder `path` at this moment. A folder to which no run has
/// written is not created.
pub fn is_written_to(path: &Path) -> bool {
    is_locked(&path.join(LOCK))
}

/// True if a file exists and another program holds its lock.
pub fn is_locked(path: &Path) -> bool {
    File::open(path).is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}
