//! The table of numbers in a file of a test rig: its rows, and what the lines above say of its
//! columns.

use std::path::Path;

use dem_io::units::{Dimension, FORCE, LENGTH, quantity};
use dem_io::{Diagnostic, Result, read_input};

use crate::numbers::{Notation, Separator};

/// Lines above the numbers in which names and units of columns are looked for.
const HEAD_LINES: usize = 4;
/// Rows of numbers, one below the other, by which the table is known.
const ROWS_OF_TABLE: usize = 3;

/// A column of a table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Column {
    /// Its name, without the unit; empty: it has none.
    pub name: String,
    /// Its unit as written; empty: it has none.
    pub unit: String,
}

/// Lines of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The columns, from the left.
    pub columns: Vec<Column>,
    /// Rows from the first to the last with numbers: number of the line, counted from 1, and its
    /// cells.
    rows: Vec<(usize, Vec<String>)>,
    notation: Notation,
}

/// The text of a file: UTF-8, UTF-16 with its mark, or Latin-1.
///
/// # Errors
/// No such file; it cannot be read; it is not text (all exit code 2).
pub fn read_text(path: &Path) -> Result<String> {
    let bytes = read_input(path, "the curve of a test")?;
    text_of(&bytes).ok_or_else(|| {
        Diagnostic::input(
            path.display().to_string(),
            "this is not text",
            "export the test as CSV or text",
        )
    })
}

/// The text that bytes stand for. None: they are not text.
fn text_of(bytes: &[u8]) -> Option<String> {
    let wide = |from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes[2..]
            .as_chunks()
            .0
            .iter()
            .map(|pair| from(*pair))
            .collect();
        String::from_utf16(&units).ok()
    };
    let text = match bytes {
        [0xFF, 0xFE, ..] => wide(u16::from_le_bytes)?,
        [0xFE, 0xFF, ..] => wide(u16::from_be_bytes)?,
        [0xEF, 0xBB, 0xBF, rest @ ..] => String::from_utf8(rest.to_vec()).ok()?,
        // The first 256 characters of Unicode are those of Latin-1.
        _ => String::from_utf8(bytes.to_vec())
            .unwrap_or_else(|_| bytes.iter().map(|byte| char::from(*byte)).collect()),
    };
    (!text.contains('\0')).then_some(text)
}

impl Table {
    /// The table in a text.
    ///
    /// # Errors
    /// No rows of numbers (exit code 2).
    pub fn of(text: &str) -> Result<Self> {
        let lines = numbered(text);
        let contents: Vec<&str> = lines.iter().map(|(_, line)| *line).collect();
        let none = || {
            Diagnostic::input(
                "",
                "has no rows with two numbers or more",
                "export travel and force as columns, a row for each moment",
            )
        };
        let notation = Notation::found_in(&contents).ok_or_else(none)?;
        let rows: Vec<(usize, Vec<&str>)> = lines
            .iter()
            .map(|(number, line)| (*number, notation.cells(line)))
            .collect();
        let is_row = |cells: &[&str]| notation.count_numbers(cells) >= 2;
        let starts_table = |rows: &[(usize, Vec<&str>)]| {
            let width = rows[0].1.len();
            rows.iter()
                .all(|(_, cells)| cells.len() == width && is_row(cells))
        };
        let first = rows
            .windows(ROWS_OF_TABLE)
            .position(starts_table)
            .ok_or_else(none)?;
        let first = with_damaged_rows(&rows, first, &notation);
        let last = rows
            .iter()
            .rposition(|(_, cells)| is_row(cells))
            .unwrap_or(first);
        let width = rows[first].1.len();
        let head: Vec<Vec<String>> = lines[first.saturating_sub(HEAD_LINES)..first]
            .iter()
            .filter_map(|(_, line)| head_cells(line, &notation, width))
            .collect();
        let owned = |cells: &Vec<&str>| cells.iter().map(|cell| (*cell).to_owned()).collect();
        Ok(Self {
            columns: columns(&head, width),
            rows: rows[first..=last]
                .iter()
                .map(|(number, cells)| (*number, owned(cells)))
                .collect(),
            notation,
        })
    }

    /// The numbers of a column, with the lines on which they stand.
    ///
    /// # Errors
    /// A row without a number there (exit code 2).
    pub fn numbers(&self, column: usize, what: &str) -> Result<Vec<f64>> {
        let number = |(line, cells): &(usize, Vec<String>)| {
            let width = self.columns.len();
            if cells.iter().skip(width).any(|cell| !cell.is_empty()) {
                let problem = format!("has {} cells, where {width} are usual", cells.len());
                let remedy = "correct or remove this line";
                return Err(Diagnostic::input(format!("line {line}"), problem, remedy));
            }
            let cell = cells.get(column).map_or("", String::as_str);
            self.notation.number(cell).ok_or_else(|| {
                let problem = match cell {
                    "" => format!("the {what} is missing"),
                    cell => format!("the {what} is '{}', not a number", cell.escape_debug()),
                };
                let remedy = "correct or remove this line";
                Diagnostic::input(format!("line {line}"), problem, remedy)
            })
        };
        self.rows.iter().map(number).collect()
    }

    /// Number of the line of a row, counted from 1.
    pub fn line(&self, row: usize) -> usize {
        self.rows.get(row).map_or(0, |(line, _)| *line)
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

/// A table whose first line names its columns and whose cells may be texts.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct TextTable {
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: Vec<(usize, Vec<String>)>,
    notation: Notation,
}

impl TextTable {
    /// The table in a text.
    ///
    /// # Errors
    /// No lines (exit code 2).
    pub(crate) fn of(text: &str) -> Result<Self> {
        let lines = numbered(text);
        let Some(((_, head), rest)) = lines.split_first() else {
            return Err(Diagnostic::input(
                "",
                "the file is empty",
                "write a line for each specimen",
            ));
        };
        let separator = [';', '\t', ',', '|']
            .into_iter()
            .find(|c| head.contains(*c));
        let separator = separator.map_or(Separator::Space, Separator::Character);
        let of = |decimal: char| Notation { separator, decimal };
        // Both signs occur in names of files: numbers decide.
        let numbers = |notation: &Notation| -> usize {
            let lines = rest.iter();
            let of_line = |(_, line): &(usize, &str)| notation.count_numbers(&notation.cells(line));
            lines.map(of_line).sum()
        };
        let notation =
            if separator != Separator::Character(',') && numbers(&of(',')) > numbers(&of('.')) {
                of(',')
            } else {
                of('.')
            };
        let cells = |line: &str| -> Vec<String> {
            notation
                .cells(line)
                .into_iter()
                .map(str::to_owned)
                .collect()
        };
        Ok(Self {
            columns: notation.cells(head).into_iter().map(named).collect(),
            rows: rest
                .iter()
                .map(|(number, line)| (*number, cells(line)))
                .collect(),
            notation,
        })
    }

    /// The cell of a row, in a column; empty where there is none.
    pub(crate) fn cell(&self, row: usize, column: usize) -> &str {
        self.rows[row].1.get(column).map_or("", String::as_str)
    }

    /// The number in a cell.
    ///
    /// # Errors
    /// It is not a number (exit code 2).
    pub(crate) fn number(&self, row: usize, column: usize, what: &str) -> Result<f64> {
        let cell = self.cell(row, column);
        self.notation.number(cell).ok_or_else(|| {
            let problem = format!("{what} is '{}', not a number", cell.escape_debug());
            let place = format!("line {}", self.rows[row].0);
            Diagnostic::input(
                place,
                problem,
                "correct it; the unit stands in the first line",
            )
        })
    }
}

/// Lines that are not blank, with their numbers, which count from 1.
fn numbered(text: &str) -> Vec<(usize, &str)> {
    let ends_by_return = !text.contains('\n');
    let lines: Vec<&str> = if ends_by_return {
        text.split('\r').collect()
    } else {
        text.lines().collect()
    };
    let lines = lines.into_iter().enumerate();
    lines
        .map(|(at, line)| (at + 1, line))
        .filter(|(_, line)| !line.trim().is_empty())
        .collect()
}

/// The first row of a table whose first good row is `first`: damaged ones between the line with the
/// units and that row belong to the table, so that they are refused and not taken for a head.
fn with_damaged_rows(rows: &[(usize, Vec<&str>)], first: usize, notation: &Notation) -> usize {
    let width = rows[first].1.len();
    let above = rows[..first].iter().rev();
    let damaged = above
        .take_while(|(_, cells)| cells.len() == width && notation.count_numbers(cells) > 0)
        .count();
    let head = (first - damaged).checked_sub(1).map(|at| &rows[at].1);
    let has_units = |cells: &Vec<&str>| {
        cells
            .iter()
            .any(|cell| is_unit(bare(cell)) || !named(cell).unit.is_empty())
    };
    if head.is_some_and(has_units) {
        first - damaged
    } else {
        first
    }
}

/// The cells of a line above the numbers. None: it has other columns than the numbers.
fn head_cells(line: &str, notation: &Notation, width: usize) -> Option<Vec<String>> {
    let line = line.trim_start_matches(['#', '%']);
    let owned = |cells: Vec<&str>| {
        cells
            .into_iter()
            .map(str::to_owned)
            .collect::<Vec<String>>()
    };
    if notation.separator != Separator::Space {
        let cells = owned(notation.cells(line));
        return (cells.len() == width).then_some(cells);
    }
    // Names may have spaces in them: "Travel [mm]   Force [N]", "Travel [mm] Force [N]".
    let words = notation.cells(line);
    let wide: Vec<&str> = line
        .split(['\t'])
        .flat_map(|part| part.split("  "))
        .collect();
    let wide: Vec<&str> = wide
        .into_iter()
        .map(str::trim)
        .filter(|cell| !cell.is_empty())
        .collect();
    let pairs: Vec<String> = words.chunks(2).map(|pair| pair.join(" ")).collect();
    [owned(wide), owned(words), pairs]
        .into_iter()
        .find(|cells| cells.len() == width)
}

/// Names and units of the columns from the lines above the numbers, the nearest last.
fn columns(head: &[Vec<String>], width: usize) -> Vec<Column> {
    let mut lines = head.iter().rev();
    let mut nearest = lines.next();
    let mut units = None;
    let is_empty_or_unit = |cell: &String| cell.is_empty() || is_unit(bare(cell));
    if nearest.is_some_and(|cells| cells.iter().all(is_empty_or_unit)) {
        units = nearest;
        nearest = lines.next();
    }
    let column = |at: usize| {
        let cell = nearest.and_then(|cells| cells.get(at));
        let mut column = named(cell.map_or("", String::as_str));
        if let Some(unit) = units.and_then(|cells| cells.get(at)) {
            bare(unit).clone_into(&mut column.unit);
        }
        column
    };
    (0..width).map(column).collect()
}

/// A unit without the brackets around it.
fn bare(cell: &str) -> &str {
    cell.trim_matches(['[', ']', '(', ')', '<', '>']).trim()
}

/// Whether a text is a unit of anything that a test rig measures.
fn is_unit(text: &str) -> bool {
    size_of(text, &LENGTH).is_some()
        || size_of(text, &FORCE).is_some()
        || matches!(
            text,
            "s" | "ms" | "min" | "%" | "-" | "MPa" | "kPa" | "Pa" | "N/mm2" | "N/mm²" | "mm/min"
        )
}

/// Size of a unit of a dimension in its SI unit. None: it is not a unit of it.
pub(crate) fn size_of(unit: &str, dimension: &Dimension) -> Option<f64> {
    let is_word = unit.starts_with(|c: char| c.is_alphabetic());
    is_word
        .then(|| quantity(&format!("1 {unit}"), dimension).ok())
        .flatten()
}

/// Name and unit from the head of a column: "Force [N]", "Force (N)", "Force / N", "Force in N",
/// "force_n".
fn named(cell: &str) -> Column {
    let of = |name: &str, unit: &str| Column {
        name: name.trim().to_owned(),
        unit: unit.trim().to_owned(),
    };
    for (open, close) in [('[', ']'), ('(', ')'), ('<', '>')] {
        if let Some((name, rest)) = cell.split_once(open)
            && let Some((unit, _)) = rest.split_once(close)
        {
            return of(name, unit);
        }
    }
    for between in ["/", " in ", ",", " "] {
        if let Some((name, unit)) = cell.rsplit_once(between)
            && is_unit(unit.trim())
        {
            return of(name, unit);
        }
    }
    if let Some((name, unit)) = cell.rsplit_once('_') {
        let known = ["m", "mm", "um", "N", "kN", "MN"];
        if let Some(unit) = known.iter().find(|known| known.eq_ignore_ascii_case(unit)) {
            return of(name, unit);
        }
    }
    of(cell, "")
}
