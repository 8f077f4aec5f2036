//! The fastest setting that is accurate enough.

use dem_io::units::{NUMBER, quantity, significant};
use dem_io::{Diagnostic, Result};

use super::row::Row;
use super::sweep_table::SweepTable;

/// A target error.
#[derive(Debug, Clone, PartialEq)]
pub struct Want {
    /// As typed by the user.
    pub text: String,
    /// The measure. None for all.
    pub measure: Option<String>,
    /// Largest error.
    pub error: f64,
}

impl Want {
    /// From `all=1%` or `NAME=1%`. `table_measures`: the measures with a reference.
    pub fn parse(text: &str, table_measures: &[&str]) -> Result<Self> {
        let place = format!("--max-error {text}");
        let form = "write all=1%, or NAME=1% for one measure";
        let Some((name, error)) = text.split_once('=') else {
            return Err(Diagnostic::input(place, "there is no =", form));
        };
        if table_measures.is_empty() {
            let problem = "no measure of the study has a reference, so there are no errors";
            let remedy = "give measures a reference, or leave --max-error out";
            return Err(Diagnostic::input(place, problem, remedy));
        }
        let name = name.trim();
        if name != "all" && !table_measures.contains(&name) {
            return Err(Diagnostic::input(
                place,
                format!("nothing that is measured is called '{name}'"),
                format!(
                    "use all for all measures, or one of {}",
                    table_measures.join(", ")
                ),
            ));
        }
        let error = quantity(error, &NUMBER).map_err(|error| error.within(&place))?;
        if error <= 0.0 {
            return Err(Diagnostic::input(place, "the error is not above 0", form));
        }
        Ok(Self {
            text: text.to_owned(),
            measure: (name != "all").then(|| name.to_owned()),
            error,
        })
    }

    /// The largest error of a run among the measures concerned. None if one of them is unknown.
    fn error_of(&self, table: &SweepTable, row: &Row) -> Option<f64> {
        let meant = table.measures.iter().zip(&row.results);
        let mut meant = meant
            .filter(|(column, _)| match &self.measure {
                Some(name) => *name == column.name,
                None => column.reference.is_some(),
            })
            .map(|(_, judged)| judged.sure_error());
        let first = meant.next()??;
        meant.try_fold(first, |largest: f64, error| Some(largest.max(error?)))
    }
}

/// The fastest run whose errors are within the targets. Of those that are equally fast within their
/// spread, the most accurate. Refuses targets that no run meets, and times of several machines.
pub fn fastest<'a>(table: &'a SweepTable, wants: &[Want]) -> Result<&'a Row> {
    let place = wants
        .iter()
        .map(|want| format!("--max-error {}", want.text));
    let place = place.collect::<Vec<_>>().join(" ");
    if table.machines.len() > 1 {
        return Err(Diagnostic::input(
            place,
            "the runs are of several machines, whose times are not compared",
            "do all of them on machines of one kind",
        ));
    }
    // Largest error over its target: 1 is just enough.
    let fraction = |row: &Row| {
        let fractions = wants
            .iter()
            .map(|want| Some(want.error_of(table, row)? / want.error));
        fractions.reduce(|a, b| Some(a?.max(b?))).flatten()
    };
    let known = || {
        table
            .runs
            .iter()
            .filter_map(|row| Some((fraction(row)?, row.time_s?, row)))
    };
    let enough = || known().filter(|(fraction, ..)| *fraction <= 1.0);
    let Some((_, least_s, _)) = enough().min_by(|a, b| a.1.total_cmp(&b.1)) else {
        let best = known().min_by(|a, b| a.0.total_cmp(&b.0));
        let problem = match best {
            Some((fraction, _, row)) => format!(
                "no run is as exact: the nearest, run {}, has {} times the error",
                row.number,
                significant(fraction, 3)
            ),
            None => "no run has an error that is known".to_owned(),
        };
        let remedy = "ask for less, or let the study vary further";
        return Err(Diagnostic::input(place, problem, remedy));
    };
    let as_fast = enough().filter(|(_, time, row)| *time <= least_s + row.spread_s.unwrap_or(0.0));
    let best = as_fast.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(.., row)| row)
        .ok_or_else(|| Diagnostic::failed(place, "no run is left", ""))
}
