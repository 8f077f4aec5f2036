//! The plots of the page.

use std::path::Path;

use dem_plots::{Axis, Line, Plot};
use serde_json::Value;

use super::bending::{self, READINGS};
use super::drops;
use super::map::{self, View};
use super::oscillation;
use crate::bench::{finished, number, read};

/// Every plot whose results are there, with the name of its file.
pub(crate) fn all(results: &Path) -> Vec<(&'static str, String)> {
    let plots = [
        ("thesis-bending.svg", curves(results)),
        ("thesis-oscillation.svg", oscillations(results)),
        ("thesis-25-flat.svg", utilisation(results, "25-flat")),
        ("thesis-25-upright.svg", utilisation(results, "25-upright")),
    ];
    let there = plots.into_iter();
    there.filter_map(|(name, svg)| Some((name, svg?))).collect()
}

/// Load over travel of the first packing of each row with the first two readings, beside the
/// line that follows from the equations of Platzer 2022: its stiffness up to its largest force.
/// Nothing unless all have been run.
fn curves(results: &Path) -> Option<String> {
    let mut lines = vec![Line {
        name: "Platzer 2022".to_owned(),
        points: vec![[0.0, 0.0], [2.82e-3, 51.45]],
        dashed: true,
    }];
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
        lines.push(Line {
            name: format!("{}, {}", row.sample.title(), row.reading),
            points: curve.step_by(4).collect(),
            dashed: false,
        });
    }
    let plot = Plot {
        title: "Four-point bending, printed bonds".to_owned(),
        x: Axis::of("travel of the pins (m)"),
        y: Axis::of("load (N)"),
        lines,
        ..Plot::default()
    };
    Some(plot.svg().file())
}

fn oscillations(results: &Path) -> Option<String> {
    let all = read(&results.join(oscillation::FILE))?;
    let line = |one: &Value| {
        let points = one["points"].as_array().map_or(&[][..], Vec::as_slice);
        Line {
            name: format!("d = {}", one["damping"].as_str().unwrap_or_default()),
            points: points
                .iter()
                .step_by(4)
                .map(|point| [number(&point[0]), number(&point[1])])
                .collect(),
            dashed: false,
        }
    };
    let plot = Plot {
        title: "Two bonded particles, pulled and released".to_owned(),
        x: Axis::of("time (s)"),
        y: Axis::of("elongation (m)"),
        lines: all
            .as_array()
            .map_or(&[][..], Vec::as_slice)
            .iter()
            .map(line)
            .collect(),
        ..Plot::default()
    };
    Some(plot.svg().file())
}

/// Utilisation and factor in the first drop of this kind that has been run with the factor, the
/// fine sample first.
fn utilisation(results: &Path, fall: &str) -> Option<String> {
    let mut rows = drops::rows();
    rows.retain(|row| row.dif);
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
