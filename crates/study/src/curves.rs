//! Load over displacement of laboratory tests, and the distance between two such curves.

use std::fs;
use std::path::Path;

use dem_plots::{Line, MOST_LINES, Plot};

use super::sweep_table::SweepTable;

/// The curve of the test with its results in this folder: points (displacement in m, load in N),
/// ascending in displacement.
///
/// # Errors
/// The reason why there is none, as text.
pub fn curve(results: &Path) -> Result<Vec<[f64; 2]>, String> {
    const FILE: &str = "force-displacement.csv";
    let text =
        fs::read_to_string(results.join(FILE)).map_err(|_| format!("it has left no {FILE}"))?;
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |wanted: &str| names.iter().position(|name| *name == wanted);
    let (Some(x), Some(y)) = (place("displacement_m"), place("load_n")) else {
        return Err(format!(
            "its {FILE} has no columns displacement_m and load_n"
        ));
    };
    let point = |line: &str| -> Option<[f64; 2]> {
        let cells: Vec<&str> = line.split(',').collect();
        Some([cells.get(x)?.parse().ok()?, cells.get(y)?.parse().ok()?])
    };
    let points: Option<Vec<[f64; 2]>> = lines.map(point).collect();
    points
        .filter(|points| points.len() > 1 && largest_n(points) > 0.0)
        .ok_or_else(|| format!("its {FILE} has no curve: nothing was loaded"))
}

/// Largest load, N.
pub fn largest_n(curve: &[[f64; 2]]) -> f64 {
    curve.iter().map(|[_, force]| *force).fold(0.0, f64::max)
}

/// The curves of a measure for as many runs as there are colours. None if the measure is not a
/// curve.
pub fn plot(table: &SweepTable, measure: usize) -> Option<Plot> {
    let runs = table.runs.iter();
    let with_curve = runs.filter(|row| {
        row.results
            .get(measure)
            .is_some_and(|j| !j.curve.is_empty())
    });
    let lines: Vec<Line> = with_curve
        .take(MOST_LINES)
        .map(|row| Line {
            name: row.settings.join(", "),
            points: row.results[measure].curve.clone(),
            dashed: !row.results[measure].is_reference,
        })
        .collect();
    (!lines.is_empty()).then(|| {
        Plot::of(
            table.measures[measure].name.replace('_', " "),
            "displacement (m)",
            "load (N)",
            lines,
        )
    })
}
