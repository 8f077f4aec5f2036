//! Summaries as JSON.

use std::path::Path;

use serde::Serialize;

use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;

/// Writes `value` to the file `path` as indented JSON, completely or not at all. Numbers that are
/// not finite become `null`.
///
/// # Errors
/// As [`write_file`]; `value` cannot be represented as JSON (exit code 1).
pub fn write_json(path: &Path, value: &impl Serialize) -> Result<()> {
    write_file(path, |out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}
