//! Input files: their bytes, or why they cannot be read.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use crate::diagnostic::{Diagnostic, Result};

/// Largest file of text, bytes: a larger one is something else, or has no end.
const MOST_BYTES: u64 = 1 << 28;

/// The bytes of a file of text, at most 256 MB, called `what` in messages ("a scene").
pub fn read_input(path: &Path, what: &str) -> Result<Vec<u8>> {
    let name = path.display().to_string();
    let read = || -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(path)?
            .take(MOST_BYTES + 1)
            .read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = read().map_err(|error| match error.kind() {
        ErrorKind::NotFound => {
            Diagnostic::input(&name, "there is no such file", "check its name and folder")
        }
        ErrorKind::IsADirectory => {
            Diagnostic::input(&name, "this is a folder", format!("name {what} in it"))
        }
        _ => {
            let remedy = "check the name and its permissions";
            Diagnostic::input(&name, format!("cannot be read: {error}"), remedy)
        }
    })?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(Diagnostic::input(
            &name,
            format!("this is larger than {} MB", MOST_BYTES >> 20),
            format!("name {what}"),
        ));
    }
    Ok(bytes)
}
