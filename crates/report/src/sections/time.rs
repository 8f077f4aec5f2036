//! Errors, steps, and where the time went.

use dem_io::units::{show_quantity, significant};
use dem_plots::{Column, Page, Table};
use dem_results::Summary;

use super::percent::percent;

/// Stages with a smaller fraction of the time are left out.
const SMALLEST_FRACTION: f64 = 0.005;

/// Errors and run time.
pub(crate) fn add_time(page: &mut Page, summary: &Summary) {
    page.heading("Errors and run time");
    let errors = [
        ("energy error", summary.energy_error),
        ("momentum error", summary.momentum_error),
        ("angular momentum error", summary.angular_momentum_error),
    ];
    let errors = errors.map(|(name, error)| [name.to_owned(), significant(error, 2)]);
    let mut rows = errors.to_vec();
    if let Some(part) = &summary.part_error {
        let error = significant(part.energy_error, 2);
        let bodies = part.bodies.join(", ");
        rows.insert(1, [format!("energy error of {bodies} by itself"), error]);
    }
    if summary.steps > 0 {
        let limit = summary.fraction_of_limit;
        let step = show_quantity(summary.time_step_s, "s");
        let of_limit = if limit > 0.0 {
            format!(
                "{step}, {} of the largest stable one",
                significant(limit, 3)
            )
        } else {
            step
        };
        rows.push(["steps".to_owned(), summary.steps.to_string()]);
        rows.push(["time step".to_owned(), of_limit]);
        rows.push([
            "steps per second".to_owned(),
            significant(summary.steps_per_s, 3),
        ]);
    }
    page.table(&Table {
        columns: vec![Column::text(""), Column::text("")],
        rows: rows.into_iter().map(|row| row.to_vec().into()).collect(),
    });
    add_stages(page, &summary.time_by_stage);
    let inactive = &summary.inactive_stages;
    if !inactive.is_empty() {
        page.small(&format!("Inactive, at no cost: {}.", inactive.join(", ")));
    }
    if summary.results.is_some() {
        page.small("dem-run report FOLDER writes this page again from the files of the folder.");
    }
}

fn add_stages(page: &mut Page, stages: &[(String, f64)]) {
    let shown = stages
        .iter()
        .filter(|(_, fraction)| *fraction >= SMALLEST_FRACTION);
    let mut bars: Vec<(String, f64, String)> = shown
        .map(|(name, fraction)| (name.clone(), *fraction, percent(*fraction)))
        .collect();
    bars.sort_by(|a, b| b.1.total_cmp(&a.1));
    page.bars(&bars);
}
