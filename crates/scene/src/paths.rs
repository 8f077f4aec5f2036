//! Files named in a scene or a study, and their text.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::field::Field;
use super::tree::Origin;
use dem_io::diagnostic::{Diagnostic, Result};

/// Largest file of a scene or study, bytes: a larger one is something else, or has no end.
const MOST_BYTES: u64 = 1 << 28;

/// The text of a file, called `what` in messages.
///
/// # Errors
/// The file cannot be read, or is not text.
pub fn text_of(path: &Path, what: &str) -> Result<String> {
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
            format!("name {what}; particles belong into a file of their own"),
        ));
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + good.iter().filter(|byte| **byte == b'\n').count();
        let remedy = "save the file as plain text in UTF-8";
        Diagnostic::input(format!("{name}:{line}"), "this is not text", remedy)
    })
}

/// The file or folder named by `field`. Names in the file are resolved against its folder, names on
/// the command line against the current folder. "-" stays.
///
/// Not a text, or an empty one.
pub(super) fn named_path(field: &Field<'_>, folder: &Path) -> Result<PathBuf> {
    let name = field.text()?;
    if name.trim().is_empty() {
        return Err(field.wrong("a name", "write a name such as \"cake.vtp\""));
    }
    let as_it_stands = name == "-" || matches!(field.node.origin, Origin::Option(_));
    Ok(if as_it_stands {
        PathBuf::from(name)
    } else {
        folder.join(name)
    })
}
