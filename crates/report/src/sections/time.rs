//! Errors, steps, and where the time went.

use dem_io::units::{show_quantity, significant};
use dem_plots::{Column, Page, Table};
use serde_json::Value;

use super::values::{number, percent, text, texts};

/// Stages with a smaller fraction of the time are left out.
const SMALLEST_FRACTION: f64 = 0.005;

/// Errors and run time.
pub(crate) fn add_time(page: &mut Page, summary: &Value) {
    page.heading("Errors and run time");
    let value = |name: &str| number(&summary[name]);
    let mut rows = vec![
        ["energy error", &significant(value("energy_error"), 2)],
        ["momentum error", &significant(value("momentum_error"), 2)],
        [
            "angular momentum error",
            &significant(value("angular_momentum_error"), 2),
        ],
    ]
    .into_iter()
    .map(|row| row.map(str::to_owned))
    .collect::<Vec<_>>();
    let part = &summary["part_error"];
    if part.is_object() {
        let error = significant(number(&part["energy_error"]), 2);
        let bodies = texts(&part["bodies"]).join(", ");
        rows.insert(1, [format!("energy error of {bodies} by itself"), error]);
    }
    let steps = value("steps");
    if steps > 0.0 {
        let limit = value("fraction_of_limit");
        let step = show_quantity(value("time_step_s"), "s");
        let of_limit = if limit > 0.0 {
            format!(
                "{step}, {} of the largest stable one",
                significant(limit, 3)
            )
        } else {
            step
        };
        rows.push(["steps".to_owned(), format!("{steps}")]);
        rows.push(["time step".to_owned(), of_limit]);
        rows.push([
            "steps per second".to_owned(),
            significant(value("steps_per_s"), 3),
        ]);
    }
    page.table(&Table {
        columns: vec![Column::text(""), Column::text("")],
        rows: rows.into_iter().map(|row| row.to_vec().into()).collect(),
    });
    add_stages(page, &summary["time_by_stage"]);
    let inactive = texts(&summary["inactive_stages"]);
    if !inactive.is_empty() {
        page.small(&format!("Inactive, at no cost: {}.", inactive.join(", ")));
    }
    let folder = text(&summary["results"]);
    if !folder.is_empty() {
        page.small("dem-run report FOLDER writes this page again from the files of the folder.");
    }
}

fn add_stages(page: &mut Page, stages: &Value) {
    let stages = stages.as_object().into_iter().flatten();
    let mut stages: Vec<(&String, f64)> = stages
        .map(|(name, fraction)| (name, number(fraction)))
        .filter(|(_, fraction)| *fraction >= SMALLEST_FRACTION)
        .collect();
    stages.sort_by(|a, b| b.1.total_cmp(&a.1));
    let bars: Vec<(String, f64, String)> = stages
        .into_iter()
        .map(|(name, fraction)| (name.clone(), fraction, percent(fraction)))
        .collect();
    page.bars(&bars);
}
