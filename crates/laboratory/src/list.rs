//! A table of specimens: file, dimensions and place of the crack of each, as a spreadsheet exports
//! it.

use std::path::{Path, PathBuf};

use dem_io::{Diagnostic, Result};

use crate::specimen::Dimensions;
use crate::table::{TextTable, read_text};
use crate::units::size_of;

/// Column of the distance of a crack from the middle of its specimen.
const CRACK: &str = "crack_offset";
/// Column of the files.
const FILE: &str = "file";

/// A specimen of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct ListedSpecimen {
    /// Its file; relative names count from the folder of the table.
    pub file: PathBuf,
    /// Its own dimensions, as far as they are in the table.
    pub dimensions: Dimensions,
    /// Distance of its crack from the middle, m. None: not known.
    pub crack_m: Option<f64>,
}

/// Reads a table of specimens. Columns: `file`, any of the [`Dimensions`] (`width (mm)`) and
/// `crack_offset (mm)`; empty cells are left to the options.
///
/// # Errors
/// No column `file`; an unknown column; a column without a unit; a cell that is not a number.
pub fn read_list(path: &Path) -> Result<Vec<ListedSpecimen>> {
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    let table = TextTable::of(&read_text(path)?).map_err(within)?;
    let mut found: Vec<ListedSpecimen> = Vec::new();
    let name = |at: usize| {
        table.columns[at]
            .name
            .to_lowercase()
            .replace([' ', '-'], "_")
    };
    let names: Vec<String> = (0..table.columns.len()).map(name).collect();
    let Some(file) = names.iter().position(|name| name == FILE) else {
        let problem = "the table has no column 'file'";
        let remedy = "write the names of the columns into its first line: file, width (mm), ...";
        return Err(within(Diagnostic::input("line 1", problem, remedy)));
    };
    let known: Vec<&str> = Dimensions::NAMES.into_iter().chain([CRACK]).collect();
    let mut sizes = vec![0.0; names.len()];
    for (at, name) in names.iter().enumerate().filter(|(at, _)| *at != file) {
        if !known.contains(&name.as_str()) {
            let problem = format!("unknown column '{}'", table.columns[at].name.escape_debug());
            let remedy = format!("use file, {}", known.join(", "));
            return Err(within(Diagnostic::input("line 1", problem, remedy)));
        }
        let dimension = Dimensions::unit_of(name).0;
        sizes[at] = size_of(&table.columns[at].unit, dimension).ok_or_else(|| {
            let problem = format!("the column '{name}' has no unit of {}", dimension.named());
            within(Diagnostic::input(
                "line 1",
                problem,
                format!("write {name} (mm)"),
            ))
        })?;
    }
    for row in 0..table.rows.len() {
        let mut listed = ListedSpecimen {
            file: path.with_file_name(table.cell(row, file)),
            dimensions: Dimensions::default(),
            crack_m: None,
        };
        for (at, name) in names.iter().enumerate().filter(|(at, _)| *at != file) {
            if table.cell(row, at).is_empty() {
                continue;
            }
            let value = sizes[at] * table.number(row, at, name).map_err(within)?;
            if name == CRACK {
                listed.crack_m = Some(value);
            } else {
                listed.dimensions.set(name, value);
            }
        }
        found.push(listed);
    }
    Ok(found)
}
