//! The plots of the page.

use dem_plots::{Line, Plot};
use std::path::Path;

use super::bending::{self, READINGS};
use super::drops::{self, Dif};
use super::map::{self, View};
use super::oscillation;
use crate::bench::{finished, number, read};

/// Every plot whose results are there, with the name of its file.
pub(crate) fn all(results: &Path) -> Vec<(&'static str, String)> {
    let plots = [
        ("thesis-bending.svg", curves(results)),
        ("thesis-oscillation.svg", oscillations()),
        (
            "thesis-25-flat.svg",
            utilisation(results, "25-flat", Dif::Present),
        ),
        (
            "thesis-25-upright.svg",
            utilisation(results, "25-upright", Dif::Present),
        ),
        (
            "thesis-25-flat-kept.svg",
            utilisation(results, "25-flat", Dif::LargestWithoutEnd),
        ),
        (
            "thesis-25-upright-kept.svg",
            utilisation(results, "25-upright", Dif::LargestWithoutEnd),
        ),
    ];
    let there = plots.into_iter();
    there.filter_map(|(name, svg)| Some((name, svg?))).collect()
}

/// Load over travel of the first packing of each row with the first two readings, beside the
/// line that follows from the equations of Platzer 2022: its stiffness up to its largest force.
/// Nothing unless all have been run.
fn curves(results: &Path) -> Option<String> {
    let equations = vec![[0.0, 0.0], [2.82e-3, 51.45]];
    let mut lines = vec![Line::dashed("Platzer 2022", equations)];
    for row in bending::rows() {
        let shown = row.sample.bond_range == "1.0" && READINGS[..2].contains(&row.reading);
        if !shown {
            continue;
        }
        let run = finished(&results.join(row.name(1)))?;
        let columns = ["displacement_m", "load_n"];
        let curve = run.columns("force-displacement.csv", columns).ok()?;
        // From where the fitted line has no load.
        let curve = curve
            .into_iter()
            .filter(|[displacement_m, _]| *displacement_m >= 0.0);
        let name = format!("{}, {}", row.sample.title(), row.reading);
        lines.push(Line::new(name, curve.step_by(4).collect()));
    }
    let [title, x] = [
        "Four-point bending, printed bonds",
        "travel of the pins (m)",
    ];
    Some(Plot::of(title, x, "load (N)", lines).svg().file())
}

fn oscillations() -> Option<String> {
    let mut lines = Vec::new();
    for damping in oscillation::DAMPING {
        let points = oscillation::curve(damping).ok()?.into_iter().step_by(4);
        lines.push(Line::new(format!("d = {damping}"), points.collect()));
    }
    let title = "Two bonded particles, pulled and released";
    Some(
        Plot::of(title, "time (s)", "elongation (m)", lines)
            .svg()
            .file(),
    )
}

/// Utilisation and factor in the first drop of this kind that has been run with the factor so
/// applied, the fine sample first.
fn utilisation(results: &Path, fall: &str, dif: Dif) -> Option<String> {
    let mut rows = drops::rows();
    rows.retain(|row| row.dif == dif);
    rows.sort_by_key(|row| row.sample.table.number());
    let (row, run) = rows.iter().find_map(|row| {
        let run = read(&results.join(format!("{}.json", row.name(fall, 1))))?;
        Some((row, run))
    })?;
    let about = format!(
        "table {}, {}, damping ratio {}, {:.1} ms after the start",
        row.sample.table.number(),
        row.reading,
        row.damping,
        1e3 * number(&run["utilisation"]["time_of_largest_mean_s"])
    );
    let views = [
        View {
            column: 3,
            from_to: [1.0, 5.0],
            title: format!("Dynamic increase factor: {about}"),
        },
        View {
            column: 2,
            from_to: [0.0, 1.0],
            title: format!("Utilisation of the dynamic strength: {about}"),
        },
    ];
    Some(map::svg(&run["utilisation"], &views))
}
