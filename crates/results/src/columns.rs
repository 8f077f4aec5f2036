//! CSV tables whose columns are functions of a row. Every number reads back as the same bits.

use std::path::Path;

use dem_io::diagnostic::Result;
use dem_io::safe_write::write_file;

/// The name of a column with its unit, and the text of a row in it.
pub type Column<R> = (&'static str, fn(&R) -> String);

/// The first line of a table, without its line break.
pub fn header<R>(columns: &[Column<R>]) -> String {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    names.join(",")
}

/// The lines of rows.
pub fn lines<R>(columns: &[Column<R>], rows: impl IntoIterator<Item = R>) -> String {
    rows.into_iter().map(|row| line(columns, &row)).collect()
}

fn line<R>(columns: &[Column<R>], row: &R) -> String {
    let texts: Vec<String> = columns.iter().map(|(_, text)| text(row)).collect();
    texts.join(",") + "\n"
}

/// Writes a table to the file `path`, completely or not at all.
pub fn write_table<R>(
    path: &Path,
    columns: &[Column<R>],
    rows: impl IntoIterator<Item = R>,
) -> Result<()> {
    write_file(path, |out| {
        writeln!(out, "{}", header(columns))?;
        for row in rows {
            out.write_all(line(columns, &row).as_bytes())?;
        }
        Ok(())
    })
}

/// The text of a value, which is empty if there is none.
pub(crate) fn known(value: Option<impl ToString>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}
