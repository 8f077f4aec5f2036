//! Places in a sheet, and cells that are empty.

use dem_io::Diagnostic;

use crate::table::Table;

/// The line of a row, for messages.
pub(super) fn line_of(table: &Table, row: usize) -> String {
    format!("line {}", table.line(row))
}

/// That a cell is empty.
pub(super) fn missing(place: &str, what: &str) -> Diagnostic {
    let problem = format!("the {what} is missing");
    Diagnostic::input(place, problem, "write it, or remove this line")
}
