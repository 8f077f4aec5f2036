//! The page of a calibration: targets and results, curves, history, and the table over sizes.

use dem_io::units::{show_quantity, significant};
use dem_plots::{Column, Line, MOST_LINES, Page, Plot, Row, Table};

use crate::case::{Case, Round};
use crate::record::Record;
use crate::resolution::{curve_error, mean_curve};
use crate::text::{coarsest_size, numbers, results, warnings};

/// Everything about a calibration on one page that needs no other file. `most_error`: wanted error
/// of the curve.
pub fn page(record: &Record, most_error: Option<f64>) -> String {
    let mut page = Page::new("calibration");
    page.paragraph(&format!(
        "{}, {}, {}; packings: {}",
        record.scene,
        record.date,
        record.program,
        record.packings.join(", ")
    ));
    if record.cases.len() > 1 {
        page.heading("Sizes of spheres");
        page.table(&sizes(record));
        page.list(
            &coarsest_size(record, most_error)
                .into_iter()
                .collect::<Vec<_>>(),
        );
    }
    for case in &record.cases {
        if !case.name.is_empty() {
            page.heading(&case.name);
        }
        page.list(&warnings(record, case));
        page.table(&results_table(results(record, case)));
        page.table(&table(
            &["number", "found", "in the scene"],
            numbers(record, case),
        ));
        page.figure(&curves(record, case).svg());
        page.table(&history(record, case));
    }
    page.html()
}

/// The table of results, from their rows.
pub(crate) fn results_table(rows: Vec<[String; 6]>) -> Table {
    let heads = [
        "result",
        "mean",
        "95 % confidence interval",
        "target",
        "deviation",
        "scatter",
    ];
    table(&heads, rows)
}

/// A table whose first column is text.
pub(crate) fn table<const N: usize>(heads: &[&str; N], rows: Vec<[String; N]>) -> Table {
    Table {
        columns: columns(heads),
        rows: rows
            .into_iter()
            .map(|row| Row::from(row.to_vec()))
            .collect(),
    }
}

pub(crate) fn columns(heads: &[&str]) -> Vec<Column> {
    let column = |(at, name): (usize, &&str)| match at {
        0 => Column::text(name),
        _ => Column::number(name),
    };
    heads.iter().enumerate().map(column).collect()
}

/// Load over displacement of each packing, their mean, and the wanted curve.
fn curves(record: &Record, case: &Case) -> Plot {
    let mut lines = Vec::new();
    if let Some(round) = case.result() {
        let named = record.packings.iter().zip(&round.trials);
        let of_trials = named.filter_map(|(name, trial)| {
            let points = trial.as_ref()?.curve.clone();
            Some(Line::new(name.clone(), points))
        });
        lines.extend(of_trials.take(MOST_LINES - 2));
        lines.push(Line::dashed("mean", mean_curve(round)));
    }
    if !record.wanted_curve.is_empty() {
        lines.push(Line::dashed("measured", record.wanted_curve.clone()));
    }
    Plot::of(
        "Load over displacement",
        "displacement (m)",
        "load (N)",
        lines,
    )
}

/// The rounds: numbers, and results of each packing.
fn history(record: &Record, case: &Case) -> Table {
    let mut heads = vec!["round".to_owned()];
    for unknown in &record.unknowns {
        heads.push(unknown.numbers[0].path.clone());
        heads.push(unknown.result.clone());
        heads.push("of each packing".to_owned());
    }
    heads.push("run time".to_owned());
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let row = |(number, round): (usize, &Round)| {
        let mut cells = vec![(number + 1).to_string()];
        for (at, (unknown, factor)) in record.unknowns.iter().zip(&round.factors).enumerate() {
            let show = |value: Option<f64>| {
                value.map_or_else(String::new, |value| show_quantity(value, &unknown.unit))
            };
            let trials = round.trials.iter().flatten();
            let each: Vec<String> = trials.map(|trial| show(trial.results[at])).collect();
            cells.push(unknown.numbers[0].text(*factor));
            cells.push(show(round.mean(at)));
            cells.push(each.join(", "));
        }
        let wall_s: f64 = round
            .trials
            .iter()
            .flatten()
            .map(|trial| trial.wall_s)
            .sum();
        cells.push(format!("{} s", significant(wall_s, 3)));
        Row::from(cells)
    };
    Table {
        columns: columns(&heads),
        rows: case.rounds.iter().enumerate().map(row).collect(),
    }
}

/// A table with one row for each size: numbers, scatter, run time and error of the curve.
pub fn sizes(record: &Record) -> Table {
    let mut heads = vec!["spheres", "particles", "bonds", "across the body"];
    for unknown in &record.unknowns {
        heads.push(&unknown.numbers[0].path);
        heads.push(&unknown.result);
        heads.push("scatter");
    }
    heads.extend(["run time of a test", "curve apart"]);
    let row = |case: &Case| {
        let mut cells = vec![
            case.name.clone(),
            case.particles.to_string(),
            case.bonds.to_string(),
            significant(case.spheres_across, 3),
        ];
        let found = case.result();
        for (at, unknown) in record.unknowns.iter().enumerate() {
            let statistic = found.and_then(|round| round.statistic(at));
            let factor = found.map_or(1.0, |round| round.factors[at]);
            cells.push(unknown.numbers[0].text(factor));
            let mean =
                |statistic: dem_laboratory::Statistic| show_quantity(statistic.mean, &unknown.unit);
            let scatter = |statistic: dem_laboratory::Statistic| {
                format!(
                    "{:.1} %",
                    100.0 * statistic.standard_deviation / statistic.mean
                )
            };
            cells.push(statistic.map_or_else(String::new, mean));
            cells.push(statistic.map_or_else(String::new, scatter));
        }
        let (wall_s, tests) = case.cost();
        cells.push(format!(
            "{} s",
            significant(wall_s / tests.max(1) as f64, 3)
        ));
        let apart = curve_error(record, case);
        cells.push(apart.map_or_else(String::new, |error| format!("{:.1} %", 100.0 * error)));
        Row::from(cells)
    };
    Table {
        columns: columns(&heads),
        rows: record.cases.iter().map(row).collect(),
    }
}
