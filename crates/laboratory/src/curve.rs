//! Force over travel as a test rig has measured it: which columns of a table they are, their units,
//! their signs.

use dem_io::units::{Dimension, FORCE, LENGTH, STRESS};
use dem_io::{Diagnostic, Result};

use crate::head::Column;
use crate::table::Table;
use crate::units::{is_weight, names_of, size_of};

/// Fewest rows of a curve.
const FEWEST_ROWS: usize = 20;
/// Largest fraction of the entire travel by which it may go back from one row to a later one.
const BACK: f64 = 0.01;
/// A gap is a step of this fraction of the entire travel and this many usual steps.
const GAP: [f64; 2] = [0.05, 20.0];

/// A specimen has failed where the force falls below this fraction of its largest.
pub const FAILED: f64 = 0.75;
/// Largest force, as a fraction of the largest of all, while the crosshead drives back behind the
/// failure.
const DRIVEN_BACK: f64 = 0.5;
/// Largest difference of two columns that hold the same, as a fraction of their range.
const SAME: f64 = 1e-3;
/// Share of the largest force by which that of two rows differs where a specimen fails at once.
const DROP: f64 = 0.1;
/// Share of the largest force by which the first one of a test is not above the last one.
const STILL_LOADED: f64 = 0.01;
/// Largest travel, m, force, N, and stress, Pa, that a test rig has.
const LARGEST: [f64; 3] = [100.0, 1e9, 1e12];

/// Words by which a column of travel is known, and of force.
const TRAVEL_WORDS: [&str; 20] = [
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
    "déplacement",
    "allongement",
    "uzama",
    "deplasman",
    "desplazamiento",
    "spostamento",
    "corsa",
];
const FORCE_WORDS: [&str; 10] = [
    "force", "load", "kraft", "last", "effort", "kuvvet", "yük", "fuerza", "carga", "forza",
];
/// Words of the stress that stands for the force in tests under pressure, and of any stress.
const SHEAR_STRESS_WORDS: [&str; 4] = ["shear", "deviator", "schubspannung", "scherspannung"];
const STRESS_WORDS: [&str; 2] = ["stress", "spannung"];
/// Words that hold one of these by chance.
const OTHER_WORDS: [&str; 2] = ["elastic", "plastic"];

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
    /// Largest value of a test rig, in the SI unit.
    largest: f64,
}

impl Curve {
    /// The curve in a table.
    ///
    /// # Errors
    /// No column, or several, could be meant; no unit; a cell that is no number; as [`Self::new`].
    pub fn of(table: &Table, travel: &ColumnChoice, force: &ColumnChoice) -> Result<Self> {
        let mut notes = Vec::new();
        let travel_m = Wanted::travel(travel).values(table, &mut notes)?;
        let force_n = Wanted::force(force).values(table, &mut notes)?;
        Self::of_columns(table, travel_m, force_n, notes)
    }

    /// The curve in a table of a test under pressure, whose file may have a stress in place of the
    /// force: the shear stress, or the axial stress above the pressure. It is multiplied by the
    /// area, m2.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn of_stress(
        table: &Table,
        travel: &ColumnChoice,
        force: &ColumnChoice,
        area_m2: f64,
    ) -> Result<Self> {
        let is_force = match &force.unit {
            Some(unit) => size_of(unit, &STRESS).is_none(),
            None => {
                let columns = Wanted::force(force).columns(table)?;
                let unit = columns.first().map(|at| table.columns[*at].unit.as_str());
                unit.is_some_and(|unit| size_of(unit, &STRESS).is_none())
            }
        };
        if is_force {
            return Self::of(table, travel, force);
        }
        let sheared = Wanted::stress(force, &SHEAR_STRESS_WORDS);
        let any = Wanted::stress(force, &STRESS_WORDS);
        let mut notes = Vec::new();
        let travel_m = Wanted::travel(travel).values(table, &mut notes)?;
        let stress_pa = match sheared.columns(table)?.is_empty() {
            true => any.values(table, &mut notes)?,
            false => sheared.values(table, &mut notes)?,
        };
        let force_n = stress_pa.iter().map(|stress| stress * area_m2).collect();
        notes.push("the force is the stress of the file times the area".to_owned());
        Self::of_columns(table, travel_m, force_n, notes)
    }

    fn of_columns(
        table: &Table,
        travel_m: Vec<f64>,
        force_n: Vec<f64>,
        mut notes: Vec<String>,
    ) -> Result<Self> {
        refuse_other_specimens(table, &travel_m)?;
        let lines = (0..table.len()).map(|row| table.line(row)).collect();
        let mut curve = Self::new(travel_m, force_n, lines)?;
        let repeated = table.repeated_heads.len();
        if repeated > 0 {
            notes.push(format!(
                "the head of the table stands again on {repeated} places: its parts are taken as one test"
            ));
        }
        notes.append(&mut curve.notes);
        Ok(Self { notes, ..curve })
    }

    /// A curve of travel, m, and force, N, whose rows stand on these lines; refuses too few rows,
    /// gaps, and travel that goes back.
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
        curve.read_backwards();
        curve.turn();
        curve.cut_return();
        curve.refuse_jumps()?;
        Ok(curve)
    }

    /// Reverses the rows of a file that has the last one first: the travel goes down from where the
    /// force has not come back to its start, and the force jumps up where that of a specimen that
    /// fails drops.
    fn read_backwards(&mut self) {
        let (travel, force) = (&self.travel_m, &self.force_n);
        let last = force.len() - 1;
        let jump = |up: f64| {
            let steps = force
                .windows(2)
                .map(|pair| up * (pair[1].abs() - pair[0].abs()));
            steps.fold(0.0, f64::max)
        };
        let peak_n = force
            .iter()
            .fold(0.0, |most: f64, force| most.max(force.abs()));
        let starts_loaded = force[0].abs() - force[last].abs() > STILL_LOADED * peak_n;
        let is_backwards = travel[last] < travel[0]
            && starts_loaded
            && jump(1.0) > DROP * peak_n
            && jump(1.0) > 2.0 * jump(-1.0);
        if is_backwards {
            self.travel_m.reverse();
            self.force_n.reverse();
            self.lines.reverse();
            self.notes.push(
                "the travel goes down from a specimen that has failed: the rows are read from the last to the first"
                    .to_owned(),
            );
        }
    }

    /// Makes travel and force positive where a test rig counts the other way.
    fn turn(&mut self) {
        let mut reverse = |name: &str, values: &mut Vec<f64>| {
            values.iter_mut().for_each(|value| *value = -*value);
            self.notes.push(format!(
                "the {name} goes down where the specimen is loaded: its sign is reversed"
            ));
        };
        let start_n = self.force_n[0];
        let far = |force: &f64| (force - start_n).abs();
        let peak = (1..self.force_n.len()).fold(0, |best, row| {
            if far(&self.force_n[row]) > far(&self.force_n[best]) {
                row
            } else {
                best
            }
        });
        // Behind the failure the crosshead may drive back, beyond its start.
        if self.travel_m[peak] < self.travel_m[0] {
            reverse("travel", &mut self.travel_m);
        }
        if self.force_n[peak] < start_n {
            reverse("force", &mut self.force_n);
        }
    }

    /// Cuts off the rows in which the crosshead drives back behind the failure.
    fn cut_return(&mut self) {
        let (travel, force) = (&self.travel_m, &self.force_n);
        let rise = |row: usize| force[row] - force[0];
        let rows = travel.len();
        let later = |best: usize, row: usize, values: &[f64]| {
            if values[row] > values[best] {
                row
            } else {
                best
            }
        };
        let peak = (1..rows).fold(0, |best, row| later(best, row, force));
        let Some(failed) = (peak..rows).find(|row| rise(*row) < FAILED * rise(peak)) else {
            return;
        };
        let far = (1..rows).fold(0, |best, row| later(best, row, travel));
        let back_m = BACK * (travel[far] - travel[0]);
        let mut lowest_m = travel[far];
        let is_return = far >= failed
            && travel[rows - 1] < travel[far] - back_m
            && (far..rows).all(|row| {
                lowest_m = lowest_m.min(travel[row]);
                rise(row) <= DRIVEN_BACK * rise(peak) && travel[row] <= lowest_m + back_m
            });
        if is_return && far + 1 >= FEWEST_ROWS {
            self.notes.push(format!(
                "behind the failure the crosshead drives back from line {} on: {} rows are cut off",
                self.lines[far + 1],
                rows - far - 1
            ));
            self.travel_m.truncate(far + 1);
            self.force_n.truncate(far + 1);
            self.lines.truncate(far + 1);
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

impl<'a> Wanted<'a> {
    fn travel(choice: &'a ColumnChoice) -> Self {
        Self {
            name: "travel",
            dimension: &LENGTH,
            unit: "mm",
            words: &TRAVEL_WORDS,
            option: "--travel",
            choice,
            place: 0,
            largest: LARGEST[0],
        }
    }

    fn force(choice: &'a ColumnChoice) -> Self {
        Self {
            name: "force",
            dimension: &FORCE,
            unit: "N",
            words: &FORCE_WORDS,
            option: "--force",
            choice,
            place: 1,
            largest: LARGEST[1],
        }
    }

    fn stress(choice: &'a ColumnChoice, words: &'a [&'a str]) -> Self {
        Self {
            name: "stress",
            dimension: &STRESS,
            unit: "kPa",
            words,
            largest: LARGEST[2],
            ..Self::force(choice)
        }
    }
}

impl Wanted<'_> {
    /// The values of the quantity, in SI units.
    fn values(&self, table: &Table, notes: &mut Vec<String>) -> Result<Vec<f64>> {
        let found = self.columns(table)?;
        let [first, others @ ..] = &found[..] else {
            return Err(self.none_known(table));
        };
        let values = self.of_column(table, *first)?;
        for other in others {
            let same = self
                .of_column(table, *other)
                .is_ok_and(|other| is_same(&values, &other));
            if !same {
                let problem = format!(
                    "several columns may be the {}: {}",
                    self.name,
                    list(table, &found)
                );
                return Err(Diagnostic::input("", problem, self.remedy()));
            }
        }
        if !others.is_empty() {
            notes.push(format!(
                "several columns hold the {}, all the same but for a sign or a start: {}; the first is taken",
                self.name,
                list(table, &found)
            ));
        }
        let unit = self.unit_of(table, *first);
        if is_weight(unit) {
            notes.push(format!(
                "the {} in {unit} is taken as pounds-force",
                self.name
            ));
        }
        Ok(values)
    }

    /// The unit of a column as written.
    fn unit_of<'a>(&'a self, table: &'a Table, column: usize) -> &'a str {
        match &self.choice.unit {
            Some(unit) => unit.as_str(),
            None => table.columns[column].unit.as_str(),
        }
    }

    /// The values of a column, in SI units.
    fn of_column(&self, table: &Table, column: usize) -> Result<Vec<f64>> {
        let unit = self.unit_of(table, column);
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
            let problem = format!(
                "the unit of the {} is '{}', which is unknown",
                self.name,
                unit.escape_debug()
            );
            let mut remedy = format!("add {option}-unit with one of {}", names_of(self.dimension));
            if unit == "kg" {
                remedy = format!("add {option}-unit kgf if the weight of kilograms is meant");
            }
            Diagnostic::input("", problem, remedy)
        })?;
        let values = table.numbers(column, self.name)?;
        let values: Vec<f64> = values.into_iter().map(|value| size * value).collect();
        let is_possible = |value: &f64| value.abs() <= self.largest;
        match values.iter().position(|value| !is_possible(value)) {
            Some(row) => {
                let problem = format!(
                    "the {} is {:e} {}, more than any test rig has ({:e})",
                    self.name, values[row], self.dimension.si, self.largest
                );
                let place = format!("line {}", table.line(row));
                Err(Diagnostic::input(
                    place,
                    problem,
                    "check the number and its unit",
                ))
            }
            None => Ok(values),
        }
    }

    /// Numbers of the columns that may be meant, counted from 0.
    fn columns(&self, table: &Table) -> Result<Vec<usize>> {
        let columns = &table.columns;
        if let Some(wanted) = &self.choice.column {
            return Ok(vec![self.named(table, wanted)?]);
        }
        let nameless = columns.iter().all(|column| column.name.is_empty());
        let unitless = columns.iter().all(|column| column.unit.is_empty());
        if nameless && columns.len() == 2 && unitless {
            return Ok(vec![self.place]);
        }
        let by_unit = |at: &usize| size_of(&columns[*at].unit, self.dimension).is_some();
        let by_name = |at: &usize| {
            let name = columns[*at].name.to_lowercase();
            let is_other = OTHER_WORDS.iter().any(|word| name.contains(word));
            !is_other && self.words.iter().any(|word| name.contains(word))
        };
        let all: Vec<usize> = (0..columns.len()).collect();
        let named: Vec<usize> = all.iter().copied().filter(by_name).collect();
        let fitting = |of: &[usize]| of.iter().copied().filter(by_unit).collect::<Vec<usize>>();
        let found = [fitting(&named), named.clone(), fitting(&all)];
        Ok(found
            .into_iter()
            .find(|found| !found.is_empty())
            .unwrap_or_default())
    }

    /// No column can be meant.
    fn none_known(&self, table: &Table) -> Diagnostic {
        let all: Vec<usize> = (0..table.columns.len()).collect();
        let problem = format!(
            "no column is known as the {}: {}",
            self.name,
            list(table, &all)
        );
        let is_strain = |column: &Column| {
            let name = column.name.to_lowercase();
            ["strain", "stress", "dehnung", "spannung"]
                .iter()
                .any(|word| name.contains(word))
        };
        let remedy = if table
            .columns
            .iter()
            .filter(|column| is_strain(column))
            .count()
            > 1
        {
            "export travel and force instead of strain and stress".to_owned()
        } else {
            self.remedy()
        };
        Diagnostic::input("", problem, remedy)
    }

    /// The column with this name or number.
    fn named(&self, table: &Table, wanted: &str) -> Result<usize> {
        let count = table.columns.len();
        if let Ok(number) = wanted.parse::<usize>()
            && (1..=count).contains(&number)
        {
            return Ok(number - 1);
        }
        let is_it = |column: &Column| {
            let same = |name: &str| name.trim().eq_ignore_ascii_case(wanted.trim());
            // As the tables of a run write it, too: `travel_m`.
            same(&column.name) || same(&format!("{}_{}", column.name, column.unit))
        };
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

/// Whether two columns hold the same but for their starts and signs.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    let range = one
        .iter()
        .fold(0.0_f64, |most, x| most.max((x - one[0]).abs()));
    let is_near = |sign: f64| {
        let pairs = one.iter().zip(other);
        let differences = pairs.map(|(a, b)| (a - one[0] - sign * (b - other[0])).abs());
        differences.fold(0.0, f64::max) <= SAME * range
    };
    one.len() == other.len() && !one.is_empty() && (is_near(1.0) || is_near(-1.0))
}

/// Refuses a file in which the travel starts again behind a repeated head.
fn refuse_other_specimens(table: &Table, travel_m: &[f64]) -> Result<()> {
    let rows = table.repeated_heads.iter().copied();
    for row in rows.filter(|row| (1..travel_m.len()).contains(row)) {
        let far = |rows: &[f64]| {
            rows.iter()
                .fold(0.0_f64, |far, x| far.max((x - rows[0]).abs()))
        };
        let [before_m, start_m] =
            [travel_m[row - 1], travel_m[row]].map(|x| (x - travel_m[0]).abs());
        if start_m < before_m - BACK * far(travel_m) {
            let problem = format!(
                "another test begins: its travel starts again at {:.4} mm, {:.4} mm before the row above",
                1e3 * travel_m[row],
                1e3 * (before_m - start_m)
            );
            let place = format!("line {}", table.line(row));
            return Err(Diagnostic::input(
                place,
                problem,
                "write a file for each specimen",
            ));
        }
    }
    Ok(())
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
