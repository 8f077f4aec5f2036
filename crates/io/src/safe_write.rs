//! Files that appear complete or not at all: written under a temporary name in the same folder,
//! then renamed.
//!
//! A temporary file is locked as long as its writer lives. The remains of a killed writer are
//! therefore recognised by their name and the missing lock, and the next writer in the folder
//! removes them.

use std::collections::BTreeSet;
use std::fs::{self, File, Metadata, Permissions, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use tempfile::NamedTempFile;

use crate::diagnostic::{Diagnostic, Result};
use crate::text::visible_json;
use crate::write_target::{folder_of, no_folder_of};

const BUFFER_BYTES: usize = 1 << 16;

/// Prefix of the names of temporary files.
pub const UNFINISHED_PREFIX: &str = ".unfinished-";

/// Number of letters and digits after it.
const RANDOM: usize = 6;
/// Largest number of attempts: a new temporary file may be taken for an abandoned one before it is
/// locked, and is then made again.
const TRIES: usize = 16;

/// Temporary files that exist at this moment.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Folders in which this process has searched for abandoned files.
static CLEANED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// A file written in full under a temporary name. If it is dropped without
/// [`PendingFile::publish`], it is removed.
#[derive(Debug)]
pub struct PendingFile {
    target: PathBuf,
    /// None for targets that cannot be renamed onto (a device, a named pipe): they are written
    /// directly.
    temporary: Option<NamedTempFile>,
}

impl PendingFile {
    /// Writes the later file `path` under its temporary name, in the same folder. An existing file
    /// stays unchanged until `publish`; an error leaves nothing behind.
    ///
    /// A device or a named pipe is written to directly; a reader that closes it early is not an
    /// error.
    pub fn write(
        path: &Path,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<Self> {
        let existing = fs::metadata(path).ok();
        if let Some(metadata) = &existing {
            check_target(path, metadata)?;
            if !metadata.is_file() {
                let written = File::options()
                    .write(true)
                    .open(path)
                    .and_then(|file| write_buffered(file, write));
                return quiet_when_closed(written)
                    .map(|()| Self {
                        target: path.to_owned(),
                        temporary: None,
                    })
                    .map_err(|error| explain(path, &error));
            }
        }
        // A link is followed to its target.
        let target = if existing.is_some() {
            fs::canonicalize(path)
        } else {
            Ok(path.to_owned())
        };
        let target = target.map_err(|error| explain(path, &error))?;
        let pending = Self {
            temporary: Some(create_beside(&target).map_err(|error| explain(path, &error))?),
            target,
        };
        pending
            .fill(existing.as_ref(), write)
            .map_err(|error| explain(path, &error))?;
        Ok(pending)
    }

    fn fill(
        &self,
        existing: Option<&Metadata>,
        write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<()> {
        let Some(temporary) = &self.temporary else {
            return Ok(());
        };
        write_buffered(temporary.as_file(), write)?;
        if let Some(existing) = existing {
            temporary
                .as_file()
                .set_permissions(existing.permissions())?;
            // The previous content is lost with the rename, so the new bytes must be on the disk
            // before.
            temporary.as_file().sync_all()?;
        }
        Ok(())
    }

    /// Renames the file to its final name, replacing an existing file, which stays on an error.
    pub fn publish(mut self) -> Result<()> {
        let Some(temporary) = self.temporary.take() else {
            return Ok(());
        };
        let mut unfinished = unfinished();
        unfinished.retain(|path| path != temporary.path());
        temporary
            .persist(&self.target)
            .map(drop)
            .map_err(|error| explain(&self.target, &error.error))
    }
}

impl Drop for PendingFile {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            unfinished().retain(|path| path != temporary.path());
        }
    }
}

/// Writes the file `path`, which appears complete or not at all.
pub fn write_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    PendingFile::write(path, write)?.publish()
}

/// Removes the temporary files of unfinished writes: for a program that is interrupted and about to
/// end.
pub fn remove_unfinished() {
    for path in unfinished().drain(..) {
        // Nothing can be done about a file that cannot be removed.
        let _ = fs::remove_file(path);
    }
}

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(crate) fn write_buffered(
    to: impl Write,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffered = BufWriter::with_capacity(BUFFER_BYTES, to);
    write(&mut buffered)?;
    buffered.flush()
}

pub(crate) fn quiet_when_closed(written: io::Result<()>) -> io::Result<()> {
    written.or_else(|error| {
        if error.kind() == ErrorKind::BrokenPipe {
            Ok(())
        } else {
            Err(error)
        }
    })
}

fn check_target(path: &Path, metadata: &Metadata) -> Result<()> {
    let place = path.display().to_string();
    if metadata.is_dir() {
        return Err(Diagnostic::failed(
            place,
            "this is a folder",
            "name a file in it",
        ));
    }
    if metadata.is_file() && metadata.permissions().readonly() {
        return Err(Diagnostic::failed(
            place,
            "this file is write-protected",
            "choose another name, or allow writing to it",
        ));
    }
    Ok(())
}

fn create_beside(target: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED_PREFIX).rand_bytes(RANDOM);
    if let Some(permissions) = usual_permissions() {
        builder.permissions(permissions);
    }
    let folder = folder_of(target);
    remove_abandoned_files(folder);
    let mut unfinished = unfinished();
    for _ in 0..TRIES {
        let temporary = builder.tempfile_in(folder)?;
        if is_ours(&temporary) {
            unfinished.push(temporary.path().to_owned());
            return Ok(temporary);
        }
    }
    Err(io::Error::other("temporary files vanish"))
}

/// Locks a new temporary file. False if another process has taken it for abandoned in the meantime.
fn is_ours(temporary: &NamedTempFile) -> bool {
    match temporary.as_file().try_lock() {
        Ok(()) => fs::symlink_metadata(temporary.path()).is_ok(),
        Err(TryLockError::WouldBlock) => false,
        // This disk does not support locks: nobody removes files from it.
        Err(TryLockError::Error(_)) => true,
    }
}

/// Removes the remains of killed writers in a folder, once per process. Files that cannot be
/// removed stay.
fn remove_abandoned_files(folder: &Path) {
    let mut cleaned = CLEANED.lock().unwrap_or_else(PoisonError::into_inner);
    if !cleaned.insert(folder.to_owned()) {
        return;
    }
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries {
        let name = entry.file_name();
        let random = name
            .to_str()
            .and_then(|name| name.strip_prefix(UNFINISHED_PREFIX));
        let is_temporary = random.is_some_and(|random| {
            random.len() == RANDOM && random.bytes().all(|byte| byte.is_ascii_alphanumeric())
        });
        if is_temporary {
            let _ = remove_if_abandoned(&entry.path());
        }
    }
}

/// Removes a temporary file unless its writer is still running. A file that cannot be opened or
/// locked stays, without an error.
pub fn remove_if_abandoned(path: &Path) -> io::Result<()> {
    if !fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_file()) {
        return Ok(());
    }
    match File::open(path) {
        // The lock is held until the file is gone, see `is_ours`.
        Ok(file) if file.try_lock().is_ok() => fs::remove_file(path),
        _ => Ok(()),
    }
}

/// Readable by others as far as the user's settings (umask) allow, as for any new file.
#[cfg(unix)]
fn usual_permissions() -> Option<Permissions> {
    Some(std::os::unix::fs::PermissionsExt::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<Permissions> {
    None
}

/// The error for a failed write to `path`.
pub fn explain(path: &Path, error: &io::Error) -> Diagnostic {
    let folder = folder_of(path).display();
    let (problem, remedy) = match error.kind() {
        ErrorKind::NotFound if !folder_of(path).exists() => no_folder_of(path),
        ErrorKind::NotADirectory => (format!("'{folder}' is not a folder"), "write elsewhere"),
        ErrorKind::PermissionDenied => (
            format!("no permission to write in '{folder}'"),
            "write elsewhere",
        ),
        ErrorKind::ReadOnlyFilesystem => (
            format!("the disk of '{folder}' is read-only"),
            "write elsewhere",
        ),
        ErrorKind::FileTooLarge => (
            format!("a limit on the size of files is reached: {error}"),
            "raise it (ulimit -f), or write elsewhere",
        ),
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => (
            format!("no space left: {error}"),
            "free some space, or write elsewhere",
        ),
        _ => (format!("cannot be written: {error}"), "write elsewhere"),
    };
    Diagnostic::failed(path.display().to_string(), problem, remedy)
}

/// Writes `value` as indented JSON for a terminal, without characters that control it. Numbers that
/// are not finite become `null`.
pub fn write_json_text(out: &mut dyn Write, value: &impl Serialize) -> io::Result<()> {
    let json = serde_json::to_string_pretty(value)?;
    write_visible_json(out, &json)?;
    out.write_all(b"\n")
}

/// Writes a JSON text for a terminal, without characters that control it; its meaning is unchanged.
pub fn write_visible_json(out: &mut dyn Write, json: &str) -> io::Result<()> {
    out.write_all(visible_json(json).as_bytes())
}

/// Writes bytes that are not text unchanged to standard output.
pub fn write_standard_bytes(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    quiet_when_closed(write_buffered(io::stdout().lock(), write))
        .map_err(|error| explain(Path::new("standard output"), &error))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_write_that_fails_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cake.vtp");
        write_file(&path, |out| out.write_all(b"old")).unwrap();
        let error = write_file(&path, |out| {
            out.write_all(b"half a new file")?;
            Err(ErrorKind::StorageFull.into())
        })
        .unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(error.problem.starts_with("no space left"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["cake.vtp"]);
        write_file(&path, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[test]
    fn nothing_appears_before_it_is_published() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let pending = PendingFile::write(&path, |out| out.write_all(b"x")).unwrap();
        assert!(!path.exists());
        assert_eq!(names(folder.path()).len(), 1);
        drop(pending);
        assert!(names(folder.path()).is_empty());
        PendingFile::write(&path, |out| out.write_all(b"x"))
            .unwrap()
            .publish()
            .unwrap();
        assert_eq!(names(folder.path()), ["a.csv"]);
    }

    #[test]
    fn missing_folder_and_folder_as_target() {
        let folder = tempfile::tempdir().unwrap();
        let error = write_file(&folder.path().join("missing/cake.vtp"), |_| Ok(())).unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(
            error.problem.starts_with("there is no folder '")
                && error.problem.ends_with("missing'"),
            "{error}"
        );
        let error = write_file(folder.path(), |_| Ok(())).unwrap_err();
        assert_eq!(error.problem, "this is a folder");
        fs::write(folder.path().join("file"), "").unwrap();
        let error = write_file(&folder.path().join("file/cake.vtp"), |_| Ok(())).unwrap_err();
        assert!(error.problem.ends_with("is not a folder"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn links_permissions_and_write_protection() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (
            folder.path().join("cake.vtp"),
            folder.path().join("link.vtp"),
        );
        fs::write(&path, "old").unwrap();
        let plain = fs::metadata(&path).unwrap().permissions().mode();
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        symlink(&path, &link).unwrap();
        write_file(&link, |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(
            fs::metadata(&path).unwrap().permissions().mode() & 0o777,
            0o640
        );
        let fresh = folder.path().join("fresh.vtp");
        write_file(&fresh, |_| Ok(())).unwrap();
        assert_eq!(
            fs::metadata(&fresh).unwrap().permissions().mode(),
            plain,
            "as any new file"
        );
        fs::set_permissions(&path, Permissions::from_mode(0o440)).unwrap();
        assert_eq!(
            write_file(&path, |_| Ok(())).unwrap_err().problem,
            "this file is write-protected"
        );
        assert_eq!(fs::read(&path).unwrap(), b"new");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn devices_are_written_to_and_stay_devices() {
        use std::os::unix::fs::FileTypeExt;
        let error = write_file(Path::new("/dev/full"), |out| out.write_all(b"x")).unwrap_err();
        assert!(error.problem.starts_with("no space left"), "{error}");
        write_file(Path::new("/dev/null"), |out| out.write_all(b"x")).unwrap();
        assert!(
            fs::metadata("/dev/null")
                .unwrap()
                .file_type()
                .is_char_device()
        );
    }

    /// Abandoned files are searched for once per folder and process: each part of the test has its
    /// own folder.
    #[test]
    fn the_next_write_removes_what_a_killed_one_left() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            ".unfinished-a1B2c3",
            ".unfinished-notes",
            ".unfinished-a1B2c34",
            "a1B2c3",
        ] {
            fs::write(folder.path().join(name), "half").unwrap();
        }
        fs::create_dir(folder.path().join(".unfinished-Folder")).unwrap();
        write_file(&folder.path().join("cake.vtp"), |_| Ok(())).unwrap();
        let kept = [
            ".unfinished-Folder",
            ".unfinished-a1B2c34",
            ".unfinished-notes",
            "a1B2c3",
            "cake.vtp",
        ];
        assert_eq!(names(folder.path()), kept);
    }

    #[test]
    fn a_write_that_is_under_way_elsewhere_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let live = folder.path().join(".unfinished-a1B2c3");
        let writer = File::create(&live).unwrap();
        writer.lock().unwrap();
        write_file(&folder.path().join("cake.vtp"), |_| Ok(())).unwrap();
        assert!(live.exists());
        remove_if_abandoned(&live).unwrap();
        assert!(live.exists());
        drop(writer);
        remove_if_abandoned(&live).unwrap();
        assert!(!live.exists());
        // Our own are locked until they have their final name.
        let pending = PendingFile::write(&folder.path().join("b.csv"), |_| Ok(())).unwrap();
        let temporary = pending.temporary.as_ref().unwrap().path().to_owned();
        remove_if_abandoned(&temporary).unwrap();
        assert!(temporary.exists());
        pending.publish().unwrap();
        assert_eq!(names(folder.path()), ["b.csv", "cake.vtp"]);
    }

    #[test]
    fn what_is_under_way_is_known() {
        let folder = tempfile::tempdir().unwrap();
        let is_known = |pending: &PathBuf| unfinished().contains(pending);
        let pending = PendingFile::write(&folder.path().join("a.csv"), |_| Ok(())).unwrap();
        let temporary = pending.temporary.as_ref().unwrap().path().to_owned();
        assert!(is_known(&temporary));
        pending.publish().unwrap();
        assert!(!is_known(&temporary));
    }
}
