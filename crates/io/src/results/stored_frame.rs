//! A frame read again.

use std::fs::File;
use std::io::{BufReader, ErrorKind};
use std::path::Path;

pub use crate::body::stored_frame::{
    BOND_LENGTH, BOND_RADIUS, BROKEN, DENSITY, FRAGMENT_ID, RADIUS, StoredFragment, StoredFrame,
    TIME,
};
use crate::body::vtp;
use crate::diagnostic::{Diagnostic, Result};

/// Reads a frame of a run.
///
/// # Errors
/// No such file, damaged, or it tells of no fragments (all exit code 2).
pub fn read_frame(path: &Path) -> Result<StoredFrame> {
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    let file = File::open(path).map_err(|error| {
        within(match error.kind() {
            ErrorKind::NotFound => {
                Diagnostic::input("", "there is no such file", "check its name and folder")
            }
            _ => Diagnostic::input("", format!("cannot be opened: {error}"), ""),
        })
    })?;
    vtp::read_frame(&mut BufReader::with_capacity(1 << 16, file)).map_err(within)
}
