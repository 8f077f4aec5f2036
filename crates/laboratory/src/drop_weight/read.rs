//! Sheets of drop-weight tests: reading.

use std::path::PathBuf;

use dem_io::units::LENGTH;
use dem_io::{Diagnostic, Result};

use super::cells::{line_of, missing};
use super::columns::{SheetColumns, SizeColumns};
use super::refused;
use super::shares::{broken, finenesses};
use super::sheet::{DropWeightSheets, DropWeightTest};
use crate::table::{Table, read_text};
use crate::units::{names_of, size_of};

/// What a sheet needs.
const NEEDED: &str =
    "write the names of the columns and at least three rows: size (mm), Ecs (kWh/t), t10 (%)";
/// A smaller size without a unit is not taken as mm.
const LEAST_MM: f64 = 0.5;

/// Reads and joins sheets; at least one.
///
/// # Errors
/// A file that cannot be read; a column that is missing; a cell without a number; units that are
/// missing or mixed; numbers that no test gives; two ores.
pub fn read_sheets(files: &[PathBuf]) -> Result<DropWeightSheets> {
    let mut joined = DropWeightSheets::default();
    let mut ores = Vec::new();
    for file in files {
        let name = file.display().to_string();
        let sheet = read_text(file).and_then(|text| {
            let table = Table::of_kind(&text, NEEDED);
            table
                .and_then(|table| sheet(&table))
                .map_err(|error| error.within(&name))
        })?;
        let named = |note: &String| format!("{name}: {note}");
        let placed = |test: &DropWeightTest| DropWeightTest {
            place: named(&test.place),
            ..test.clone()
        };
        ores.extend(
            sheet
                .ores
                .iter()
                .map(|(ore, place)| (ore.clone(), named(place))),
        );
        joined.notes.extend(sheet.notes.iter().map(named));
        joined.tests.extend(sheet.tests.iter().map(placed));
        joined.files.push(name);
    }
    refused::two_ores(&ores)?;
    joined.ore = ores
        .first()
        .map_or_else(String::new, |(ore, _)| ore.clone());
    refused::implausible(&joined.tests)?;
    Ok(joined)
}

/// What a table holds.
struct Sheet {
    tests: Vec<DropWeightTest>,
    /// Names of ores, and their places.
    ores: Vec<(String, String)>,
    notes: Vec<String>,
}

fn sheet(table: &Table) -> Result<Sheet> {
    let columns = SheetColumns::of(&table.columns)?;
    let mut notes = Vec::new();
    let finenesses = finenesses(table, &columns.fineness)?;
    let broken = broken(table, &columns)?;
    table.refuse_mixed(columns.energy, "energy")?;
    let mut tests = Vec::new();
    for (row, broken) in broken.into_iter().enumerate() {
        let place = line_of(table, row);
        let energy = table.number(row, columns.energy, "energy")?;
        let energy = energy.ok_or_else(|| missing(&place, "energy"))?;
        let mut test = DropWeightTest {
            size_m: size_m(table, &columns, row)?,
            energy_j_kg: columns.energy_unit_j_kg * energy,
            broken,
            place,
            ..DropWeightTest::default()
        };
        for shares in &finenesses {
            match shares.values[row] {
                Some(share) if shares.n == 10.0 => test.t10 = Some(share),
                Some(share) => test.family.push([shares.n, share]),
                None => {}
            }
        }
        if test.t10.is_none() && test.broken.is_none() {
            return Err(missing(&test.place, "t10"));
        }
        refused::impossible(&test)?;
        tests.push(test);
    }
    if columns.size_unit_m.is_none() {
        notes.push("sizes without a unit are taken as mm".to_owned());
    }
    if !columns.others.is_empty() {
        notes.push(format!("not read: {}", columns.others.join(", ")));
    }
    let ores = ores_in(table, &columns);
    Ok(Sheet { tests, ores, notes })
}

/// The size in a row: the geometric mean of the two sieves where both are given.
fn size_m(table: &Table, columns: &SheetColumns, row: usize) -> Result<f64> {
    let place = line_of(table, row);
    let (numbers, unit) = match columns.size {
        SizeColumns::Sieves(both) => {
            let number = |column: usize| {
                let found = table.number(row, column, "size")?;
                found.ok_or_else(|| missing(&place, "size"))
            };
            (vec![number(both[0])?, number(both[1])?], "")
        }
        SizeColumns::One(column) => match table.number(row, column, "size") {
            Ok(Some(size)) => (vec![size], ""),
            Ok(None) => return Err(missing(&place, "size")),
            Err(error) => {
                let (numbers, unit) = numbers_in(table.cell(row, column), table.decimal());
                if numbers.len() != 2 {
                    return Err(error);
                }
                (numbers, unit)
            }
        },
    };
    let unit_m = match (unit, columns.size_unit_m) {
        ("", Some(unit_m)) => unit_m,
        ("", None) => 1e-3,
        (unit, _) => size_of(unit, &LENGTH).ok_or_else(|| {
            let problem = format!("'{}' is not a unit of the size", unit.escape_debug());
            let remedy = format!("use one of {}", names_of(&LENGTH));
            Diagnostic::input(&place, problem, remedy)
        })?,
    };
    if let Some(size) = numbers.iter().find(|size| **size <= 0.0) {
        let problem = format!("the size is {size}, not above 0");
        return Err(Diagnostic::input(
            place,
            problem,
            "correct or remove this line",
        ));
    }
    let size = match numbers[..] {
        [one, other] => (one * other).sqrt(),
        _ => numbers[0],
    };
    if unit.is_empty() && columns.size_unit_m.is_none() && size < LEAST_MM {
        let problem = format!("the size is {size} without a unit, below {LEAST_MM} mm");
        return Err(Diagnostic::input(
            place,
            problem,
            "write the unit behind the name: size (m)",
        ));
    }
    Ok(unit_m * size)
}

/// The numbers in a text such as `31.5 x 26.5`, `-31.5+26.5`, `26,5-31,5 mm`, and the unit behind
/// them, which may be empty. Signs in it are those of sieves: `-` passing, `+` retained.
fn numbers_in(text: &str, decimal: char) -> (Vec<f64>, &str) {
    let is_part = |c: char| c.is_ascii_digit() || c == decimal;
    let end = text.rfind(is_part).map_or(0, |at| at + 1);
    let (numbers, unit) = text.split_at(end);
    let found = numbers.split(|c: char| !is_part(c));
    let parsed = found.filter_map(|number| number.replace(decimal, ".").parse().ok());
    (parsed.collect(), unit.trim())
}

/// Names of the ores in a sheet, each once, with the line where it stands first. A column of
/// samples in which each row has its own name numbers the rows.
fn ores_in(table: &Table, columns: &SheetColumns) -> Vec<(String, String)> {
    let Some(column) = columns.ore else {
        return Vec::new();
    };
    let mut ores: Vec<(String, String)> = Vec::new();
    for row in 0..table.len() {
        let ore = table.cell(row, column);
        if !ore.is_empty()
            && !ores
                .iter()
                .any(|(known, _)| refused::is_same_ore(known, ore))
        {
            ores.push((ore.to_owned(), line_of(table, row)));
        }
    }
    if columns.is_sample && ores.len() == table.len() {
        return Vec::new();
    }
    ores
}
