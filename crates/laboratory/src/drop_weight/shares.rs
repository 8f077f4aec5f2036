//! Shares in a sheet: parts of the mass, and of the specimens that broke.

use dem_io::{Diagnostic, Result};

use super::cells::{line_of, missing};
use super::columns::{Fineness, ShareUnit, SheetColumns};
use crate::table::Table;

/// Most specimens of a row.
const MOST_SPECIMENS: f64 = 1e6;

/// A column of parts of the mass.
pub(super) struct Shares {
    pub(super) n: f64,
    /// Of each row. None: the cell is empty.
    pub(super) values: Vec<Option<f64>>,
}

/// The columns of t_n. Those whose head gives no unit have that of another one, or else the one
/// that the values of t10 show.
pub(super) fn finenesses(table: &Table, columns: &[Fineness]) -> Result<Vec<Shares>> {
    let said = columns
        .iter()
        .map(|one| one.unit)
        .find(|unit| *unit != ShareUnit::Unsaid);
    let usual = match said {
        Some(unit) => unit,
        None => shown_by_values(table, columns)?,
    };
    let shares = |one: &Fineness| {
        let unit = if one.unit == ShareUnit::Unsaid {
            usual
        } else {
            one.unit
        };
        let values = shares_in(table, one.column, unit, &format!("t{}", one.n))?;
        Ok(Shares { n: one.n, values })
    };
    columns.iter().map(shares).collect()
}

/// The unit of the values of t10: percent if one is above 1; refuses values on both sides of 1.
fn shown_by_values(table: &Table, columns: &[Fineness]) -> Result<ShareUnit> {
    let mut largest: f64 = 0.0;
    let mut small = None;
    for one in columns.iter().filter(|one| one.n == 10.0) {
        for row in 0..table.len() {
            if let Some(value) = table.number(row, one.column, "t10")? {
                largest = largest.max(value);
                if value > 0.0 && value <= 1.0 {
                    small = small.or(Some((row, value)));
                }
            }
        }
    }
    match small {
        Some((row, value)) if largest > 1.0 => {
            let problem = format!(
                "the t10 is {value}, that of another line {largest}: percent and fractions are mixed, or the unit is missing"
            );
            let remedy = "write all in percent, and the unit behind the name: t10 (%)";
            Err(Diagnostic::input(line_of(table, row), problem, remedy))
        }
        _ if largest > 1.0 => Ok(ShareUnit::Percent),
        _ => Ok(ShareUnit::Fraction),
    }
}

/// The shares in a column as fractions.
fn shares_in(
    table: &Table,
    column: usize,
    unit: ShareUnit,
    what: &str,
) -> Result<Vec<Option<f64>>> {
    table.refuse_mixed(column, what)?;
    let share = |row: usize| {
        let Some(value) = table.number(row, column, what)? else {
            return Ok(None);
        };
        let refuse = |problem: String, remedy: &str| {
            Err(Diagnostic::input(line_of(table, row), problem, remedy))
        };
        let (whole, sign) = match unit {
            ShareUnit::Percent => (100.0, " %"),
            ShareUnit::Fraction | ShareUnit::Unsaid => (1.0, ""),
        };
        if value < 0.0 {
            return refuse(
                format!("the {what} is {value}{sign}, below 0"),
                "correct or remove this line",
            );
        }
        if value <= whole {
            return Ok(Some(value / whole));
        }
        let problem = format!("the {what} is {value}{sign}, above {whole}{sign}");
        if unit == ShareUnit::Percent {
            refuse(problem, "correct or remove this line")
        } else {
            let problem =
                format!("{problem}, in a column of fractions: percent and fractions are mixed");
            refuse(
                problem,
                "write all in percent, and the unit behind the name, such as t10 (%)",
            )
        }
    };
    (0..table.len()).map(share).collect()
}

/// Number of specimens and of those that broke, of each row. None: not measured.
pub(super) fn broken(table: &Table, columns: &SheetColumns) -> Result<Vec<Option<[f64; 2]>>> {
    let Some((column, unit)) = columns.broken else {
        return Ok(vec![None; table.len()]);
    };
    let numbers = |column: usize, what: &str| -> Result<Vec<Option<f64>>> {
        (0..table.len())
            .map(|row| table.number(row, column, what))
            .collect()
    };
    let values = numbers(column, "number of broken specimens")?;
    let counts = match columns.specimens {
        Some(column) => numbers(column, "number of specimens")?,
        None => single_specimens(&values)?,
    };
    let is_share = match unit {
        ShareUnit::Unsaid => is_share(table, &values, &counts)?,
        ShareUnit::Percent | ShareUnit::Fraction => true,
    };
    let shares = match is_share {
        true => shares_in(table, column, unit, "share of broken specimens")?,
        false => Vec::new(),
    };
    let one = |row: usize| {
        let (Some(value), place) = (values[row], line_of(table, row)) else {
            return Ok(None);
        };
        let count = counts[row].ok_or_else(|| missing(&place, "number of specimens"))?;
        let remedy = "correct this line";
        if !(1.0..=MOST_SPECIMENS).contains(&count) || count.fract() != 0.0 {
            let problem = format!(
                "the number of specimens is {count}, not a whole number from 1 to {MOST_SPECIMENS}"
            );
            return Err(Diagnostic::input(place, problem, remedy));
        }
        if let Some(share) = shares.get(row).copied().flatten() {
            return Ok(Some([count, share * count]));
        }
        if value < 0.0 || value > count {
            let problem = format!("{value} specimens broke, of {count}");
            return Err(Diagnostic::input(place, problem, remedy));
        }
        Ok(Some([count, value]))
    };
    (0..table.len()).map(one).collect()
}

/// One specimen a row, where each either broke or not.
fn single_specimens(values: &[Option<f64>]) -> Result<Vec<Option<f64>>> {
    if values
        .iter()
        .flatten()
        .any(|value| *value != 0.0 && *value != 1.0)
    {
        let problem = "there is a column of broken specimens, but none of the number of specimens";
        let remedy = "add a column: specimens";
        return Err(Diagnostic::input("", problem, remedy));
    }
    Ok(vec![Some(1.0); values.len()])
}

/// Whether a column without a unit holds shares: fractions, not numbers of specimens.
fn is_share(table: &Table, values: &[Option<f64>], counts: &[Option<f64>]) -> Result<bool> {
    let rows = || {
        values
            .iter()
            .enumerate()
            .filter_map(|(row, value)| Some((row, (*value)?)))
    };
    if rows().any(|(_, value)| value.fract() != 0.0) {
        return Ok(true);
    }
    let several = rows().find(|(row, _)| counts[*row].is_some_and(|count| count > 1.0));
    match several {
        Some((row, value)) if rows().all(|(_, value)| value <= 1.0) => {
            let problem = format!(
                "broken is {value}: a share or a number of specimens, as no row has more than 1"
            );
            let remedy = "write the unit behind the name: broken (%)";
            Err(Diagnostic::input(line_of(table, row), problem, remedy))
        }
        _ => Ok(false),
    }
}
