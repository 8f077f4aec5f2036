//! The page of a calibration by several tests.

use dem_io::units::{show_quantity, significant};
use dem_plots::{Line, MOST_LINES, Page, Plot, Row, Table};

use super::state::Joint;
use super::text::{failure_lines, numbers, results, warnings};
use crate::case::Round;
use crate::page::{columns, results_table, table};

/// Everything about a calibration by several tests on one page that needs no other file.
pub fn joint_page(joint: &Joint) -> String {
    let mut page = Page::new("calibration by several tests");
    page.paragraph(&format!("{}, {}", joint.date, joint.program));
    page.list(&warnings(joint));
    page.table(&table(
        &["number", "found", "in the scenes"],
        numbers(joint),
    ));
    page.list(&failure_lines(joint));
    for (at, test) in joint.tests.iter().enumerate() {
        page.heading(&test.scene);
        page.paragraph(&format!(
            "{}; packings: {}; {} across the body",
            test.kind.name(),
            test.packings.join(", "),
            significant(test.spheres_across, 3)
        ));
        page.table(&results_table(results(joint, at)));
        page.figure(&curves(joint, at).svg());
    }
    page.heading("Rounds");
    page.table(&history(joint));
    page.html()
}

/// Load over displacement of each packing of a test, and the measured curve.
fn curves(joint: &Joint, at: usize) -> Plot {
    let test = &joint.tests[at];
    let mut lines = Vec::new();
    if let Some(round) = joint.result() {
        let named = test.packings.iter().zip(&round.trials[joint.trials_of(at)]);
        let of_trials = named.filter_map(|(name, trial)| {
            Some(Line::new(name.clone(), trial.as_ref()?.curve.clone()))
        });
        lines.extend(of_trials.take(MOST_LINES - 1));
    }
    if !test.wanted_curve.is_empty() {
        lines.push(Line::dashed("measured", test.wanted_curve.clone()));
    }
    Plot::of(
        "Load over displacement",
        "displacement (m)",
        "load (N)",
        lines,
    )
}

/// The rounds: numbers, and the mean of each result.
fn history(joint: &Joint) -> Table {
    let mut heads = vec!["round".to_owned()];
    let unknowns = joint.unknowns.iter();
    heads.extend(unknowns.map(|unknown| unknown.numbers[0].path.clone()));
    let aims = joint.aims.iter();
    heads.extend(aims.map(|aim| format!("{}: {}", joint.tests[aim.test].scene, aim.result)));
    heads.push("run time".to_owned());
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let row = |(number, round): (usize, &Round)| {
        let mut cells = vec![(number + 1).to_string()];
        let pairs = joint.unknowns.iter().zip(&round.factors);
        cells.extend(pairs.map(|(unknown, factor)| unknown.numbers[0].text(*factor)));
        for (at, aim) in joint.aims.iter().enumerate() {
            let statistic = joint.statistic(round, at);
            cells
                .push(statistic.map_or_else(String::new, |one| show_quantity(one.mean, &aim.unit)));
        }
        let trials = round.trials.iter().flatten();
        let wall_s: f64 = trials.map(|trial| trial.wall_s).sum();
        cells.push(format!("{} s", significant(wall_s, 3)));
        Row::from(cells)
    };
    Table {
        columns: columns(&heads),
        rows: joint.rounds.iter().enumerate().map(row).collect(),
    }
}
