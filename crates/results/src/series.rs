//! Time series as one CSV table that grows during a run.
//!
//! The first line names the columns and their units: `time_s,kinetic_energy_j,...`. Every number
//! reads back as the same bits.

use std::io::BufRead;
use std::path::Path;

use super::growing::{Table, field, fields};
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::lines::{Lines, float, on_line};
use dem_io::open_input;
use dem_io::text::exact;

/// The file of the time series.
#[derive(Debug)]
pub struct SeriesFile {
    /// The table.
    pub table: Table,
    columns: usize,
}

impl SeriesFile {
    /// A new file with these columns after the time, named with their units: `kinetic_energy_j`.
    /// Replaces an existing one.
    pub fn create(path: &Path, columns: &[String]) -> Result<Self> {
        Ok(Self {
            table: Table::create(path, &header(columns))?,
            columns: columns.len(),
        })
    }

    /// The file of an interrupted run, truncated to its length at the checkpoint, `length_bytes`.
    pub fn continue_at(path: &Path, columns: &[String], length_bytes: u64) -> Result<Self> {
        Ok(Self {
            table: Table::continue_at(path, &header(columns), length_bytes)?,
            columns: columns.len(),
        })
    }

    /// Appends a row: the time and one value for each column, in SI units. It is in the file when
    /// this returns; an error keeps earlier rows.
    pub fn append(&mut self, time_s: f64, values: &[f64]) -> Result<()> {
        if values.len() != self.columns {
            return Err(Diagnostic::failed(
                "time series",
                format!("{} values for {} columns", values.len(), self.columns),
                "this is a fault of the program",
            ));
        }
        let mut row = exact(time_s);
        for value in values {
            row.push(',');
            row += &exact(*value);
        }
        row.push('\n');
        self.table.append(&row)
    }
}

/// Time series read from a file, for example for plots.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Series {
    /// Names of the columns with their units, without the time.
    pub columns: Vec<String>,
    /// Times, s. One per row.
    pub times_s: Vec<f64>,
    /// Values of each column, in SI units. One list per column with one value per row.
    pub values: Vec<Vec<f64>>,
}

/// Reads the file of a [`SeriesFile`]; refuses other columns than the time first, and rows that are
/// incomplete or not numeric.
pub fn read_series(path: &Path) -> Result<Series> {
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    read_lines(&mut open_input(path)?).map_err(within)
}

fn read_lines(input: &mut dyn BufRead) -> Result<Series> {
    let mut lines = Lines::new(input);
    let (_, first) = lines.next_line()?.unwrap_or((1, ""));
    let mut columns = fields(first);
    if columns.remove(0) != "time_s" {
        return Err(Diagnostic::input(
            "line 1",
            "the first column is not 'time_s'",
            "name a file series.csv that dem-run wrote",
        ));
    }
    let mut series = Series {
        values: vec![Vec::new(); columns.len()],
        columns,
        times_s: Vec::new(),
    };
    while let Some((number, line)) = lines.next_line()? {
        let on_line = |error| on_line(number, error);
        let mut words = line.split(',');
        series
            .times_s
            .push(float(words.next(), "time_s").map_err(on_line)?);
        for (name, values) in series.columns.iter().zip(&mut series.values) {
            values.push(float(words.next(), name).map_err(on_line)?);
        }
        if words.next().is_some() {
            let problem = format!("more than {} values", series.columns.len() + 1);
            let remedy = "the first line names the columns";
            return Err(on_line(Diagnostic::input("", problem, remedy)));
        }
    }
    Ok(series)
}

fn header(columns: &[String]) -> String {
    let mut header = "time_s".to_owned();
    for column in columns {
        header.push(',');
        header.push_str(&field(column));
    }
    header
}
