//! Input files: their bytes, or why they cannot be read.

use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read};
use std::path::Path;

use crate::diagnostic::{Diagnostic, Result};

/// Largest file of text, bytes: a larger one is something else, or has no end.
const MOST_BYTES: u64 = 1 << 28;

/// Size of the buffer of a file that is read, bytes.
pub(crate) const BUFFER_BYTES: usize = 1 << 16;

/// Opens a file for reading.
pub fn open_input(path: &Path) -> Result<BufReader<File>> {
    let opened = if path.is_dir() {
        Err(ErrorKind::IsADirectory.into())
    } else {
        File::open(path)
    };
    match opened {
        Ok(file) => Ok(BufReader::with_capacity(BUFFER_BYTES, file)),
        Err(error) => Err(explain_read(path, &error, "a file")),
    }
}

/// Why `what` ("a scene") cannot be read from `path`.
pub fn explain_read(path: &Path, error: &io::Error, what: &str) -> Diagnostic {
    let (problem, remedy) = match error.kind() {
        ErrorKind::NotFound => (
            "there is no such file".to_owned(),
            "check its name and folder".to_owned(),
        ),
        _ if path.is_dir() => ("this is a folder".to_owned(), format!("name {what} in it")),
        _ => (
            format!("cannot be read: {error}"),
            "check the name and its permissions".to_owned(),
        ),
    };
    Diagnostic::input(path.display().to_string(), problem, remedy)
}

/// The bytes of a file of text, at most 256 MB, called `what` in messages ("a scene").
pub fn read_input(path: &Path, what: &str) -> Result<Vec<u8>> {
    let read = || -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(path)?
            .take(MOST_BYTES + 1)
            .read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = read().map_err(|error| explain_read(path, &error, what))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Diagnostic::input(
            path.display().to_string(),
            format!("this is larger than {} MB", MOST_BYTES >> 20),
            format!("name {what}"),
        ));
    }
    Ok(bytes)
}
