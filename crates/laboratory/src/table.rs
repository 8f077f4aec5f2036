//! The table of numbers in a file of a test rig: its rows, and what the lines above say of its
//! columns.

use std::ops::Range;
use std::path::Path;

use dem_io::{Diagnostic, Result, read_input};

use crate::head::{Column, columns, has_units, head_cells, named};
use crate::numbers::{Content, Notation, Separator};

/// Lines above the numbers in which names and units of columns are looked for.
const HEAD_LINES: usize = 4;
/// Rows of numbers, one below the other, by which the table is known.
const ROWS_OF_TABLE: usize = 3;
/// What to do with a line that cannot be read.
const CORRECT: &str = "correct or remove this line";

/// Lines of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// The columns, from the left.
    pub columns: Vec<Column>,
    /// Rows from the first to the last with numbers: number of the line, counted from 1, and its
    /// cells.
    rows: Vec<(usize, Vec<String>)>,
    /// Rows before which the head of the table stands again.
    pub(crate) repeated_heads: Vec<usize>,
    notation: Notation,
}

/// The text of a file: UTF-8, UTF-16, or Latin-1.
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
    let wide = |bytes: &[u8], from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks().0.iter().map(|pair| from(*pair)).collect();
        String::from_utf16(&units).ok()
    };
    let text = match bytes {
        [0xFF, 0xFE, rest @ ..] => wide(rest, u16::from_le_bytes)?,
        [0xFE, 0xFF, rest @ ..] => wide(rest, u16::from_be_bytes)?,
        // Without a mark: every other byte of plain letters and digits is 0.
        _ if has_zeros(bytes, 1) => wide(bytes, u16::from_le_bytes)?,
        _ if has_zeros(bytes, 0) => wide(bytes, u16::from_be_bytes)?,
        [0xEF, 0xBB, 0xBF, rest @ ..] => String::from_utf8(rest.to_vec()).ok()?,
        // The first 256 characters of Unicode are those of Latin-1.
        _ => String::from_utf8(bytes.to_vec())
            .unwrap_or_else(|_| bytes.iter().map(|byte| char::from(*byte)).collect()),
    };
    (!text.contains('\0')).then_some(text)
}

/// Whether most pairs of bytes are 0 at this place in them.
fn has_zeros(bytes: &[u8], place: usize) -> bool {
    let pairs = bytes.as_chunks::<2>().0;
    let zeros = pairs
        .iter()
        .filter(|pair| pair[place] == 0 && pair[1 - place] != 0);
    !pairs.is_empty() && 10 * zeros.count() > 9 * pairs.len()
}

/// A line of a file: its number, counted from 1, and its cells.
type Cells<'a> = (usize, Vec<&'a str>);

impl Table {
    /// The table in the text of a force-displacement curve; refuses one without rows of numbers.
    pub fn of(text: &str) -> Result<Self> {
        Self::of_kind(
            text,
            "export travel and force as columns, a row for each moment",
        )
    }

    /// The table in a text; refuses one without rows of numbers, with this remedy.
    pub(crate) fn of_kind(text: &str, remedy: &str) -> Result<Self> {
        let lines = numbered(text);
        let contents: Vec<&str> = lines.iter().map(|(_, line)| *line).collect();
        let none = || {
            let problem = format!(
                "has no {ROWS_OF_TABLE} rows with two numbers or more, one below the other"
            );
            Diagnostic::input("", problem, remedy)
        };
        let mut notation = Notation::found_in(&contents).ok_or_else(none)?;
        let rows: Vec<Cells<'_>> = lines
            .iter()
            .map(|(number, line)| (*number, notation.cells(line)))
            .collect();
        let found = table_rows(&rows, &notation).ok_or_else(none)?;
        let first = found.start;
        notation.is_shown = (rows[found.clone()].iter())
            .any(|(_, cells)| cells.iter().any(|cell| notation.shows(cell)));
        let width = rows[first].1.len();
        let filled = rows[first].1.iter().rposition(|cell| !cell.is_empty());
        let empty = width - filled.map_or(0, |at| at + 1);
        let head_lines = &lines[first.saturating_sub(HEAD_LINES)..first];
        let head: Vec<Vec<String>> = head_lines
            .iter()
            .filter_map(|(_, line)| head_cells(line, &notation, width, empty))
            .collect();
        refuse_decimal_commas_between_commas(head_lines, &rows[first], &notation)?;
        let heads: Vec<String> = head_lines.iter().map(|(_, line)| skeleton(line)).collect();
        let owned = |cells: &Vec<&str>| cells.iter().map(|cell| (*cell).to_owned()).collect();
        let mut kept: Vec<(usize, Vec<String>)> = Vec::new();
        let mut repeated_heads = Vec::new();
        for at in found {
            let skeleton = skeleton(lines[at].1);
            if skeleton.contains(char::is_alphabetic) && heads.contains(&skeleton) {
                repeated_heads.push(kept.len());
            } else {
                kept.push((rows[at].0, owned(&rows[at].1)));
            }
        }
        repeated_heads.dedup();
        Ok(Self {
            columns: columns(&head, width),
            rows: kept,
            repeated_heads,
            notation,
        })
    }

    /// The numbers of a column, called `what` in messages; refuses a row without one.
    pub fn numbers(&self, column: usize, what: &str) -> Result<Vec<f64>> {
        self.refuse_mixed(column, what)?;
        let number = |row: usize| {
            self.number(row, column, what)?.ok_or_else(|| {
                let place = format!("line {}", self.line(row));
                let problem = format!("the {what} is missing");
                Diagnostic::input(place, problem, CORRECT)
            })
        };
        (0..self.rows.len()).map(number).collect()
    }

    /// The number in a cell, called `what` in messages. None: the cell is empty.
    pub(crate) fn number(&self, row: usize, column: usize, what: &str) -> Result<Option<f64>> {
        let (line, cells) = &self.rows[row];
        let width = self.columns.len();
        if cells.iter().skip(width).any(|cell| !cell.is_empty()) {
            let problem = format!("has {} cells, where {width} are usual", cells.len());
            return Err(Diagnostic::input(format!("line {line}"), problem, CORRECT));
        }
        match (
            self.cell(row, column),
            self.notation.content(self.cell(row, column)),
        ) {
            ("", _) => Ok(None),
            (_, Content::Number(value)) => Ok(Some(value)),
            (cell, Content::Unclear) => Err(self.unclear(*line, cell, what)),
            (cell, Content::Text) => {
                let problem = format!("the {what} is '{}', not a number", cell.escape_debug());
                Err(Diagnostic::input(format!("line {line}"), problem, CORRECT))
            }
        }
    }

    /// The text in a cell; empty where there is none.
    pub(crate) fn cell(&self, row: usize, column: usize) -> &str {
        self.rows[row].1.get(column).map_or("", String::as_str)
    }

    /// The decimal sign of its numbers.
    pub(crate) fn decimal(&self) -> char {
        self.notation.decimal
    }

    /// Refuses a column of whole numbers, the larger of which may have a sign between thousands:
    /// `998`, `999`, `1.000`.
    pub(crate) fn refuse_mixed(&self, column: usize, what: &str) -> Result<()> {
        let notation = &self.notation;
        let cells = || {
            let rows = self.rows.iter();
            rows.filter_map(|(line, cells)| Some((*line, cells.get(column)?.as_str())))
        };
        let has_sign = |cell: &str| cell.contains(notation.decimal);
        let first = cells().find(|(_, cell)| notation.may_be_thousands(cell));
        let is_other = |cell: &str| has_sign(cell) && !notation.may_be_thousands(cell);
        let is_whole = |cell: &str| {
            let value = notation.number(cell);
            !has_sign(cell) && value.is_some_and(|value| value != 0.0 && value.abs() < 1e3)
        };
        match first {
            Some((line, cell))
                if !cells().any(|(_, cell)| is_other(cell))
                    && cells().any(|(_, cell)| is_whole(cell)) =>
            {
                Err(self.unclear(line, cell, what))
            }
            _ => Ok(()),
        }
    }

    fn unclear(&self, line: usize, cell: &str, what: &str) -> Diagnostic {
        let whole: String = cell.chars().filter(|c| !matches!(c, '.' | ',')).collect();
        Diagnostic::input(
            format!("line {line}"),
            format!(
                "the {what} is '{cell}', which may be {} or {whole}: the file does not show which sign is the decimal one",
                cell.replace(',', ".")
            ),
            "export it without a sign between thousands",
        )
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
    /// The table in a text; refuses one without lines.
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
        let of = |decimal: char| Notation::of(separator, decimal);
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

    /// The number in a cell, called `what` in messages.
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

/// The rows of the table: the longest run of rows of numbers, with those before and behind it that
/// belong to it. None: there is none of [`ROWS_OF_TABLE`].
fn table_rows(rows: &[Cells<'_>], notation: &Notation) -> Option<Range<usize>> {
    let is_row = |cells: &[&str]| notation.count_numbers(cells) >= 2;
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (at, (_, cells)) in rows.iter().enumerate() {
        match runs.last_mut() {
            Some(run)
                if run.end == at && is_row(cells) && rows[run.start].1.len() == cells.len() =>
            {
                run.end = at + 1;
            }
            _ if is_row(cells) => runs.push(at..at + 1),
            _ => {}
        }
    }
    runs.retain(|run| run.len() >= ROWS_OF_TABLE);
    let longest = (0..runs.len()).rev().max_by_key(|at| runs[*at].len())?;
    // Another table has another head; damaged rows and the same head again belong to this one.
    let head_of = |first: usize| {
        let above = first.checked_sub(1).map(|at| &rows[at].1);
        above.filter(|cells| notation.count_numbers(cells) == 0 && has_units(cells))
    };
    let belong = |one: &Range<usize>, next: &Range<usize>| {
        let head = head_of(next.start);
        let width = |run: &Range<usize>| rows[run.start].1.len();
        width(one) == width(next) && (head.is_none() || head == head_of(one.start))
    };
    let mut first = longest;
    while first > 0 && belong(&runs[first - 1], &runs[first]) {
        first -= 1;
    }
    let mut last = longest;
    while last + 1 < runs.len() && belong(&runs[last], &runs[last + 1]) {
        last += 1;
    }
    let end = runs[last].end;
    // Behind it, single rows follow a damaged one, up to the head of another table.
    let other = (end..rows.len()).find(|at| head_of(at + 1).is_some());
    let behind = &rows[end..other.unwrap_or(rows.len())];
    let more = behind.iter().rposition(|(_, cells)| is_row(cells));
    let start = with_damaged_rows(rows, runs[first].start, notation);
    Some(start..end + more.map_or(0, |at| at + 1))
}

/// A line without its digits and the signs in numbers, by which a head is known again.
fn skeleton(line: &str) -> String {
    let is_part = |c: &char| !c.is_ascii_digit() && !matches!(c, '.' | ',' | ' ');
    line.chars().filter(is_part).collect()
}

/// Refuses rows in which commas are decimal signs and stand between cells, too.
fn refuse_decimal_commas_between_commas(
    head: &[(usize, &str)],
    (line, cells): &Cells<'_>,
    notation: &Notation,
) -> Result<()> {
    let whole = cells.iter().all(|cell| !cell.contains('.'));
    if notation.separator != Separator::Character(',') || !whole {
        return Ok(());
    }
    let names = head.iter().rev().find_map(|(_, text)| {
        let names = notation.cells(text);
        (names.len() >= 2 && has_units(&names)).then_some(names.len())
    });
    let Some(names) = names.filter(|names| cells.len() > *names && cells.len() <= 2 * names) else {
        return Ok(());
    };
    Err(Diagnostic::input(
        format!("line {line}"),
        format!(
            "has {} cells below a head of {names}: commas stand in numbers and between them",
            cells.len()
        ),
        "export it with semicolons or tabs, or with a decimal point",
    ))
}

/// The first row of a table whose first good row is `first`: damaged ones between the line with the
/// units and that row belong to the table, so that they are refused and not taken for a head.
fn with_damaged_rows(rows: &[Cells<'_>], first: usize, notation: &Notation) -> usize {
    let width = rows[first].1.len();
    let above = rows[..first].iter().rev();
    let damaged = above
        .take_while(|(_, cells)| cells.len() == width && notation.count_numbers(cells) > 0)
        .count();
    let head = (first - damaged).checked_sub(1).map(|at| &rows[at].1);
    if head.is_some_and(|cells| has_units(cells)) {
        first - damaged
    } else {
        first
    }
}
