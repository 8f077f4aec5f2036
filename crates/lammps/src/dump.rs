//! Text dumps of LAMMPS: sections of atoms or of local entries.
//!
//! <https://docs.lammps.org/dump.html>

use std::io::BufRead;

use dem_io::lines::{Lines, on_line};
use dem_io::{Diagnostic, Result};

/// What to do about a damaged dump.
const AGAIN: &str = "run LAMMPS again, or copy the dump again";

/// A section of a dump: the rows at one time.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Section {
    /// Time, s. None: the dump has none.
    pub time_s: Option<f64>,
    /// Number of the time step.
    pub step: u64,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// Rows, each as long as `columns`.
    pub rows: Vec<Vec<f64>>,
}

impl Section {
    /// The numbers of the columns with these names.
    pub(crate) fn find<const N: usize>(&self, names: [impl AsRef<str>; N]) -> Result<[usize; N]> {
        let mut found = [0; N];
        for (slot, name) in found.iter_mut().zip(&names) {
            let name = name.as_ref();
            let at = self.columns.iter().position(|column| column == name);
            *slot = at.ok_or_else(|| {
                let problem = format!("there is no column '{name}'");
                self.refused(problem, "keep the dump commands of the exported script")
            })?;
        }
        Ok(found)
    }

    /// What is wrong with it, and the remedy (exit code 2).
    pub(crate) fn refused(&self, problem: impl Into<String>, remedy: &str) -> Diagnostic {
        Diagnostic::input(format!("step {}", self.step), problem.into(), remedy)
    }
}

/// Reads the sections of a dump one by one.
pub(crate) struct Dump<'a> {
    lines: Lines<'a>,
    /// The name of the item that begins the next section.
    next: Option<String>,
}

impl<'a> Dump<'a> {
    /// Begins to read.
    pub(crate) fn new(input: &'a mut dyn BufRead) -> Result<Self> {
        let mut lines = Lines::new(input);
        let next = lines.next_whole_line()?.map(|(_, line)| line.to_owned());
        Ok(Self { lines, next })
    }

    /// The next section. None: the file ends before one, or within it, as that of an interrupted
    /// run does.
    pub(crate) fn section(&mut self) -> Result<Option<Section>> {
        let mut section = Section::default();
        let mut count = None;
        while let Some(item) = self.next.take() {
            let Some(name) = item.strip_prefix("ITEM: ") else {
                return Err(Diagnostic::input(
                    "",
                    format!("'{}' is not the head of a section", item.escape_debug()),
                    "it must be a text dump of LAMMPS: dump custom or dump local",
                ));
            };
            if let Some(columns) = name
                .strip_prefix("ATOMS ")
                .or(name.strip_prefix("ENTRIES "))
            {
                section.columns = columns
                    .split_ascii_whitespace()
                    .map(str::to_owned)
                    .collect();
                let is_whole = self.take_rows(&mut section, count.unwrap_or(0))?;
                self.next = self.word()?;
                return Ok(is_whole.then_some(section));
            }
            match name.split(' ').next() {
                Some("TIME") => section.time_s = self.number()?,
                Some("TIMESTEP") => match self.count()? {
                    Some(step) => section.step = step,
                    None => return Ok(None),
                },
                Some("NUMBER") => match self.count()? {
                    Some(number) => count = Some(number),
                    None => return Ok(None),
                },
                Some("BOX") => {
                    for _ in 0..3 {
                        self.word()?;
                    }
                }
                _ => {
                    self.word()?;
                }
            }
            self.next = self.word()?;
        }
        Ok(None)
    }

    fn word(&mut self) -> Result<Option<String>> {
        let line = self.lines.next_whole_line()?;
        Ok(line.map(|(_, line)| line.to_owned()))
    }

    fn number(&mut self) -> Result<Option<f64>> {
        let line = self.lines.next_whole_line()?;
        line.map(|(number, line)| parsed(line).map_err(|error| on_line(number, error)))
            .transpose()
    }

    fn count(&mut self) -> Result<Option<u64>> {
        let line = self.lines.next_whole_line()?;
        let parsed = |(number, line): (u64, &str)| {
            line.parse().map_err(|_| {
                let problem = format!("'{}' is not a whole number from 0", line.escape_debug());
                on_line(number, Diagnostic::input("", problem, AGAIN))
            })
        };
        line.map(parsed).transpose()
    }

    /// Reads this many rows. False: the file ends before.
    fn take_rows(&mut self, section: &mut Section, count: u64) -> Result<bool> {
        let width = section.columns.len();
        for _ in 0..count {
            let Some((number, line)) = self.lines.next_whole_line()? else {
                return Ok(false);
            };
            let wrong = |problem| on_line(number, Diagnostic::input("", problem, AGAIN));
            if line.starts_with("ITEM:") {
                let rows = section.rows.len();
                let problem = format!("a section begins after {rows} rows of {count}");
                return Err(wrong(problem));
            }
            let row: Result<Vec<f64>> = line.split_ascii_whitespace().map(parsed).collect();
            let row = row.map_err(|error| on_line(number, error))?;
            if row.len() != width {
                return Err(wrong(format!("{} numbers for {width} columns", row.len())));
            }
            section.rows.push(row);
        }
        Ok(true)
    }
}

/// A finite number.
fn parsed(word: &str) -> Result<f64> {
    let number: Option<f64> = word.parse().ok();
    number.filter(|number| number.is_finite()).ok_or_else(|| {
        let problem = format!("'{}' is not a finite number", word.escape_debug());
        Diagnostic::input("", problem, AGAIN)
    })
}
