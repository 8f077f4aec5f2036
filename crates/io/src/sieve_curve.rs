//! Sieve curves: a table of openings and cumulative passing.
//!
//! Two columns, separated by comma, semicolon or tab. The unit of the opening is in the header
//! (`opening_mm`, `Opening [mm]`) or at each value (`2 mm`). Passing is a percentage or a fraction:
//! by the header (`%`, `percent`, `fraction`), or else by whether a value exceeds 1. Coarsest or
//! finest first; `#` begins a comment; with semicolons a decimal comma is accepted.

use crate::diagnostic::{Diagnostic, Result};
use crate::input_file::read_input;
use crate::units::{length_m, length_unit_m, significant};
use std::path::Path;

/// Largest gap at 0 or 100 % of a curve that is still stretched to the full range.
const LARGEST_GAP: f64 = 0.05;

/// A cumulative curve from 0 to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct SieveCurve {
    /// Openings, m, ascending. At least 2.
    pub openings_m: Vec<f64>,
    /// Fraction that passes, never falling, first 0 and last 1. One per opening.
    pub passing: Vec<f64>,
    /// Changes to the curve, to be appended to a sentence. May be empty.
    pub note: String,
    /// Fractions below the smallest and above the largest opening that were left out. Length 2.
    pub left_out: [f64; 2],
}

struct Row {
    line: usize,
    opening_m: f64,
    passing: f64,
}

/// The curve in a file.
///
/// # Errors
/// A file that cannot be read, or that is no cumulative curve.
pub fn read(path: &str) -> Result<SieveCurve> {
    let bytes = read_input(Path::new(path), "a sieve curve").map_err(|mut error| {
        error.problem = format!("cannot read the sieve curve: {}", error.problem);
        error.remedy = "give the path of a text file of openings and passing".to_owned();
        error
    })?;
    let text = String::from_utf8(bytes).map_err(|_| {
        Diagnostic::input(
            path,
            "the sieve curve is not text in UTF-8",
            "give the path of a text file of openings and passing",
        )
    })?;
    parse(&text).map_err(|e| e.within(path))
}

fn at(line: usize, problem: String, remedy: &str) -> Diagnostic {
    Diagnostic::input(format!("line {line}"), problem, remedy)
}

/// The sieve curve in a text.
///
/// # Errors
/// A text that is no cumulative curve.
pub fn parse(text: &str) -> Result<SieveCurve> {
    let lines: Vec<(usize, &str)> = (1..)
        .zip(text.trim_start_matches('\u{feff}').lines())
        .map(|(number, line)| (number, line.split('#').next().unwrap_or_default().trim()))
        .filter(|(_, line)| !line.is_empty())
        .collect();
    let all_text = || lines.iter().map(|(_, line)| *line);
    let separator = [';', '\t', ',']
        .into_iter()
        .find(|s| all_text().any(|line| line.contains(*s)))
        .unwrap_or(',');
    let decimal_comma = separator == ';' && !all_text().any(|line| line.contains('.'));

    let mut header = None;
    let mut rows = Vec::new();
    for (index, (line, text)) in lines.iter().enumerate() {
        let cells: Vec<String> = text
            .split(separator)
            .map(|c| {
                if decimal_comma {
                    c.trim().replace(',', ".")
                } else {
                    c.trim().to_owned()
                }
            })
            .collect();
        let starts_with_number =
            cells[0].starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+'));
        if index == 0 && !starts_with_number {
            header = Some(cells);
            continue;
        }
        rows.push(row(*line, &cells, header.as_deref())?);
    }
    if rows.len() < 2 {
        return Err(Diagnostic::input(
            "",
            format!(
                "{} sieve opening{} found, a curve needs at least 2",
                rows.len(),
                if rows.len() == 1 { "" } else { "s" }
            ),
            "give one line for each opening: opening, cumulative passing",
        ));
    }
    let percent = match header
        .as_ref()
        .and_then(|h| h.get(1))
        .map(|h| h.to_ascii_lowercase())
    {
        Some(h) if h.contains('%') || h.contains("percent") => true,
        Some(h) if h.contains("fraction") => false,
        _ => text.contains('%') || rows.iter().any(|r| r.passing > 1.0),
    };
    if percent {
        for row in &mut rows {
            row.passing /= 100.0;
        }
    }
    curve(rows)
}

/// One line of the table; passing as written.
fn row(line: usize, cells: &[String], header: Option<&[String]>) -> Result<Row> {
    let [opening, passing] = cells else {
        return Err(at(
            line,
            format!("{} values, expected 2", cells.len()),
            "write opening, cumulative passing",
        ));
    };
    let has_unit = opening.ends_with(|c: char| c.is_alphabetic());
    let opening_m = match header.and_then(header_unit_m) {
        Some(unit) if !has_unit => length_m(opening).map(|v| v * unit),
        None if !has_unit => {
            return Err(at(
                line,
                format!("opening '{opening}' has no unit"),
                "name the unit in the header, such as opening_mm, or at each value, such as 2mm",
            ));
        }
        _ => length_m(opening),
    }
    .map_err(|e| e.within(&format!("line {line}")))?;
    if opening_m <= 0.0 {
        return Err(at(
            line,
            format!("opening '{opening}' is not positive"),
            "let the curve begin at the size of the smallest particle, with 0 % passing",
        ));
    }
    let passing = passing
        .trim_end_matches('%')
        .trim()
        .parse::<f64>()
        .ok()
        .filter(|p| p.is_finite())
        .ok_or_else(|| {
            at(
                line,
                format!("passing '{passing}' is not a number"),
                "write a percentage or a fraction",
            )
        })?;
    Ok(Row {
        line,
        opening_m,
        passing,
    })
}

/// The last unit of length named in the first column's heading.
fn header_unit_m(header: &[String]) -> Option<f64> {
    let words = header.first()?.split(|c: char| !c.is_alphanumeric()).rev();
    words
        .filter(|w| !w.is_empty())
        .find_map(|word| length_unit_m(word).ok())
}

/// Refuses passing outside 0 to 1, and a curve that does not rise.
fn check_rising(rows: &[Row]) -> Result<()> {
    for row in rows {
        if !(0.0..=1.0).contains(&row.passing) {
            let percent = significant(100.0 * row.passing, 6);
            return Err(at(
                row.line,
                format!("{percent} % passing is outside 0 to 100 %"),
                "passing is cumulative, 0 to 100 %",
            ));
        }
    }
    for pair in rows.windows(2) {
        let line = pair[0].line.max(pair[1].line);
        if pair[1].opening_m <= pair[0].opening_m {
            return Err(at(
                line,
                "the openings are not in order".to_owned(),
                "sort them, each opening once",
            ));
        }
        if pair[1].passing < pair[0].passing {
            return Err(at(
                line,
                format!(
                    "less passes the larger opening ({} %) than the smaller ({} %)",
                    significant(100.0 * pair[1].passing, 4),
                    significant(100.0 * pair[0].passing, 4)
                ),
                "give what passes each sieve, cumulative, not what is retained",
            ));
        }
    }
    Ok(())
}

/// Refuses a curve that begins too far above 0 or ends too far below 1.
fn check_ends(rows: &[Row]) -> Result<()> {
    let (first, last) = (rows[0].passing, rows[rows.len() - 1].passing);
    if first > LARGEST_GAP {
        return Err(at(
            rows[0].line,
            format!(
                "{} % passes the smallest opening, at most {} % may",
                significant(100.0 * first, 4),
                100.0 * LARGEST_GAP
            ),
            "add the size that nothing passes, with 0 %",
        ));
    }
    if last < 1.0 - LARGEST_GAP {
        return Err(at(
            rows[rows.len() - 1].line,
            format!(
                "only {} % passes the largest opening, at least {} % must",
                significant(100.0 * last, 4),
                100.0 * (1.0 - LARGEST_GAP)
            ),
            "add the size that everything passes, with 100 %",
        ));
    }
    Ok(())
}

/// Checks the rows (passing as fractions) and stretches them to the full range.
fn curve(mut rows: Vec<Row>) -> Result<SieveCurve> {
    if rows[0].opening_m > rows[1].opening_m {
        rows.reverse();
    }
    check_rising(&rows)?;
    check_ends(&rows)?;
    let (first, last) = (rows[0].passing, rows[rows.len() - 1].passing);
    let note = if first > 0.0 || last < 1.0 {
        format!(
            "; {} % below the smallest and {} % above the largest opening left out",
            significant(100.0 * first, 3),
            significant(100.0 * (1.0 - last), 3)
        )
    } else {
        String::new()
    };
    // Flat ends contain no particles: the sizes begin and end where the curve rises.
    let rising = rows
        .windows(2)
        .position(|p| p[1].passing > p[0].passing)
        .unwrap_or(0);
    let risen = rows
        .windows(2)
        .rposition(|p| p[1].passing > p[0].passing)
        .map_or(rows.len() - 1, |i| i + 1);
    let rows = &rows[rising..=risen];
    Ok(SieveCurve {
        openings_m: rows.iter().map(|r| r.opening_m).collect(),
        passing: rows
            .iter()
            .map(|r| (r.passing - first) / (last - first))
            .collect(),
        note,
        left_out: [first, 1.0 - last],
    })
}
