//! Files named in a scene or a study, and their text.

use std::path::{Path, PathBuf};

use super::field::Field;
use super::tree::Origin;
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::read_input;

/// The text of a file, called `what` in messages.
pub fn text_of(path: &Path, what: &str) -> Result<String> {
    let bytes = read_input(path, what)?;
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + good.iter().filter(|byte| **byte == b'\n').count();
        let remedy = "save the file as plain text in UTF-8";
        Diagnostic::input(
            format!("{}:{line}", path.display()),
            "this is not text",
            remedy,
        )
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
