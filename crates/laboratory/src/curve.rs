//! Force over travel as a test rig has measured it: which columns of a table they are, their units,
//! their signs.

use dem_io::units::{Dimension, FORCE, LENGTH};
use dem_io::{Diagnostic, Result};

use crate::table::{Column, Table, size_of};

/// Fewest rows of a curve.
const FEWEST_ROWS: usize = 20;
/// Largest fraction of the entire travel by which it may go back from one row to a later one.
const BACK: f64 = 0.01;
/// A gap is a step of this fraction of the entire travel and this many usual steps.
const GAP: [f64; 2] = [0.05, 20.0];

/// Words by which a column of travel is known, and of force.
const TRAVEL_WORDS: [&str; 13] = [
    "travel",
    "displacement",
    "extension",
    "crosshead",
    "stroke",
    "deflection",
    "position",
    "weg",
    "traverse",
    "durchbiegung",
    "verformung",
    "course",
    "deplacement",
];
const FORCE_WORDS: [&str; 5] = ["force", "load", "kraft", "last", "effort"];

/// A column as the user names it: by its name or its number, and its unit.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ColumnChoice {
    /// Name of the column, or its number, counted from 1. None: it is found.
    pub column: Option<String>,
    /// Unit. None: the one in the head of the column.
    pub unit: Option<String>,
}

/// Force over travel, as measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Crosshead travel, rising, m. Length rows.
    pub travel_m: Vec<f64>,
    /// Force, positive where the specimen is loaded, N. Length rows.
    pub force_n: Vec<f64>,
    /// Line of each row in its file. Length rows.
    pub lines: Vec<usize>,
    /// What was changed or assumed, a sentence each.
    pub notes: Vec<String>,
}

/// One of the two quantities that a curve takes from a table.
struct Wanted<'a> {
    /// Its name in messages.
    name: &'static str,
    dimension: &'static Dimension,
    /// A usual unit.
    unit: &'static str,
    words: &'a [&'a str],
    /// The option that names it.
    option: &'static str,
    choice: &'a ColumnChoice,
    /// Where a table of two columns without names has it.
    place: usize,
}

impl Curve {
    /// The curve in a table.
    ///
    /// # Errors
    /// No column, or several, could be meant; no unit is known; a cell is not a number; too few
    /// rows; gaps; travel that goes back (all exit code 2).
    pub fn of(table: &Table, travel: &ColumnChoice, force: &ColumnChoice) -> Result<Self> {
        let travel = Wanted {
            name: "travel",
            dimension: &LENGTH,
            unit: "mm",
            words: &TRAVEL_WORDS,
            option: "--travel",
            choice: travel,
            place: 0,
        };
        let force = Wanted {
            name: "force",
            dimension: &FORCE,
            unit: "N",
            words: &FORCE_WORDS,
            option: "--force",
            choice: force,
            place: 1,
        };
        let travel_m = travel.values(table)?;
        let force_n = force.values(table)?;
        let lines = (0..table.len()).map(|row| table.line(row)).collect();
        Self::new(travel_m, force_n, lines)
    }

    /// A curve of travel, m, and force, N, whose rows stand on these lines.
    ///
    /// # Errors
    /// Too few rows; gaps; travel that goes back (all exit code 2).
    pub fn new(travel_m: Vec<f64>, force_n: Vec<f64>, lines: Vec<usize>) -> Result<Self> {
        let mut curve = Self {
            travel_m,
            force_n,
            lines,
            notes: Vec::new(),
        };
        let rows = curve.travel_m.len();
        if rows < FEWEST_ROWS {
            let problem = format!("has {rows} rows of numbers");
            let remedy = format!("a curve takes at least {FEWEST_ROWS}: export the entire test");
            return Err(Diagnostic::input("", problem, remedy));
        }
        curve.turn();
        curve.refuse_jumps()?;
        Ok(curve)
    }

    /// Makes travel and force positive where a test rig counts the other way.
    fn turn(&mut self) {
        let falls = |values: &[f64]| {
            let start = values[0];
            let far = |sign: f64| {
                values
                    .iter()
                    .map(|x| sign * (x - start))
                    .fold(0.0, f64::max)
            };
            far(-1.0) > far(1.0)
        };
        for (name, values) in [("travel", &mut self.travel_m), ("force", &mut self.force_n)] {
            if falls(values) {
                values.iter_mut().for_each(|value| *value = -*value);
                let note = format!(
                    "the {name} goes down where the specimen is loaded: its sign is reversed"
                );
                self.notes.push(note);
            }
        }
    }

    /// Refuses missing rows and specimens that were unloaded on the way.
    fn refuse_jumps(&self) -> Result<()> {
        let travel = &self.travel_m;
        let span_m = travel.iter().fold(travel[0], |most, x| most.max(*x)) - travel[0];
        let mut steps: Vec<f64> = travel.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        let usual_m = steps[steps.len() / 2];
        let mut farthest = 0;
        for row in 1..travel.len() {
            let place = format!("line {}", self.lines[row]);
            let [before, here] = [row - 1, row].map(|row| 1e3 * travel[row]);
            let step_m = travel[row] - travel[row - 1];
            if step_m > GAP[0] * span_m && step_m > GAP[1] * usual_m {
                let problem = format!("the travel jumps from {before:.4} to {here:.4} mm");
                return Err(Diagnostic::input(
                    place,
                    problem,
                    "rows are missing: export the entire test",
                ));
            }
            if travel[row] < travel[farthest] - BACK * span_m {
                let problem = format!(
                    "the travel goes back from {:.4} mm (line {}) to {here:.4} mm",
                    1e3 * travel[farthest],
                    self.lines[farthest]
                );
                let remedy = "keep one loading: remove the rows of unloading or of another test";
                return Err(Diagnostic::input(place, problem, remedy));
            }
            if travel[row] > travel[farthest] {
                farthest = row;
            }
        }
        Ok(())
    }
}

impl Wanted<'_> {
    /// The values of the quantity, in SI units.
    fn values(&self, table: &Table) -> Result<Vec<f64>> {
        let column = self.column(table)?;
        let unit = match &self.choice.unit {
            Some(unit) => unit.as_str(),
            None => table.columns[column].unit.as_str(),
        };
        let option = self.option;
        if unit.is_empty() {
            let problem = format!(
                "the unit of the {} is not in the head of its column",
                self.name
            );
            return Err(Diagnostic::input(
                "",
                problem,
                format!("add {option}-unit {}", self.unit),
            ));
        }
        let size = size_of(unit, self.dimension).ok_or_else(|| {
            let units: Vec<&str> = self.dimension.units.iter().map(|(unit, _)| *unit).collect();
            Diagnostic::input(
                "",
                format!(
                    "the unit of the {} is '{}', which is unknown",
                    self.name,
                    unit.escape_debug()
                ),
                format!("add {option}-unit with one of {}", units.join(", ")),
            )
        })?;
        let values = table.numbers(column, self.name)?;
        Ok(values.into_iter().map(|value| size * value).collect())
    }

    /// Number of the column, counted from 0.
    fn column(&self, table: &Table) -> Result<usize> {
        let columns = &table.columns;
        if let Some(wanted) = &self.choice.column {
            return self.named(table, wanted);
        }
        let nameless = columns.iter().all(|column| column.name.is_empty());
        if nameless && columns.len() == 2 {
            return Ok(self.place);
        }
        let by_unit = |at: &usize| size_of(&columns[*at].unit, self.dimension).is_some();
        let by_name = |at: &usize| {
            let name = columns[*at].name.to_lowercase();
            self.words.iter().any(|word| name.contains(word))
        };
        let all: Vec<usize> = (0..columns.len()).collect();
        let named: Vec<usize> = all.iter().copied().filter(by_name).collect();
        let fitting = |of: &[usize]| of.iter().copied().filter(by_unit).collect::<Vec<usize>>();
        for found in [fitting(&named), named.clone(), fitting(&all)] {
            match found[..] {
                [] => {}
                [only] => return Ok(only),
                _ => {
                    let problem = format!(
                        "several columns may be the {}: {}",
                        self.name,
                        list(table, &found)
                    );
                    return Err(Diagnostic::input("", problem, self.remedy()));
                }
            }
        }
        let problem = format!(
            "no column is known as the {}: {}",
            self.name,
            list(table, &all)
        );
        Err(Diagnostic::input("", problem, self.remedy()))
    }

    /// The column with this name or number.
    fn named(&self, table: &Table, wanted: &str) -> Result<usize> {
        let count = table.columns.len();
        if let Ok(number) = wanted.parse::<usize>()
            && (1..=count).contains(&number)
        {
            return Ok(number - 1);
        }
        let is_it = |column: &Column| column.name.trim().eq_ignore_ascii_case(wanted.trim());
        table.columns.iter().position(is_it).ok_or_else(|| {
            let all: Vec<usize> = (0..count).collect();
            let problem = format!(
                "no column is called '{}': {}",
                wanted.escape_debug(),
                list(table, &all)
            );
            Diagnostic::input("", problem, self.remedy())
        })
    }

    fn remedy(&self) -> String {
        format!("name one by {}-column NAME or its number", self.option)
    }
}

/// Columns for a message: `1 'Time [s]', 2 'Force [N]'`.
fn list(table: &Table, columns: &[usize]) -> String {
    let one = |at: &usize| {
        let column = &table.columns[*at];
        let unit = match column.unit.as_str() {
            "" => String::new(),
            unit => format!(" [{unit}]"),
        };
        format!("{} '{}{unit}'", at + 1, column.name)
    };
    columns.iter().map(one).collect::<Vec<String>>().join(", ")
}
