//! Load over displacement of laboratory tests, and the distance between two such curves.

use std::fs;
use std::path::Path;

use dem_io::interpolation::interpolated;
use dem_plots::{Axis, Line, MOST_LINES, Plot};

use super::rows::SweepTable;

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

/// The area between two curves over the area under the second, from zero displacement to the later
/// of the two largest loads. Points are joined by lines; beyond its last point a curve keeps its
/// last load.
pub fn distance(curve: &[[f64; 2]], reference: &[[f64; 2]]) -> f64 {
    let at_peak = |points: &[[f64; 2]]| {
        let peak = points.iter().max_by(|a, b| a[1].total_cmp(&b[1]));
        peak.map_or(0.0, |[x, _]| *x)
    };
    let end = at_peak(curve).max(at_peak(reference));
    let inner = curve.iter().chain(reference).map(|[x, _]| *x);
    let mut places: Vec<f64> = inner.filter(|x| *x > 0.0 && *x < end).collect();
    places.extend([0.0, end]);
    places.sort_by(f64::total_cmp);
    let (mut between, mut under) = (0.0, 0.0);
    for ends in places.windows(2) {
        let width_m = ends[1] - ends[0];
        let load_n = |points, x| interpolated(points, x).unwrap_or(0.0);
        let [own, other] =
            [curve, reference].map(|points| [load_n(points, ends[0]), load_n(points, ends[1])]);
        between += width_m * mean_size(own[0] - other[0], own[1] - other[1]);
        under += 0.5 * width_m * (other[0] + other[1]);
    }
    between / under
}

/// Mean of |y| for y changing linearly from `from` to `to`.
fn mean_size(from: f64, to: f64) -> f64 {
    if from * to < 0.0 {
        0.5 * (from * from + to * to) / (from.abs() + to.abs())
    } else {
        0.5 * (from + to).abs()
    }
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
    (!lines.is_empty()).then(|| Plot {
        title: table.measures[measure].name.replace('_', " "),
        x: Axis::of("displacement (m)"),
        y: Axis::of("load (N)"),
        lines,
        ..Plot::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_that_are_a_known_way_apart() {
        let line = [[0.0, 0.0], [1.0, 2.0], [2.0, 4.0]];
        assert_eq!(distance(&line, &line), 0.0);
        // The same line with other points, and before contact.
        let same = [[-1.0, -2.0], [0.5, 1.0], [2.0, 4.0]];
        assert!(distance(&same, &line) < 1e-15);
        let stiffer = [[0.0, 0.0], [2.0, 4.4]];
        assert!((distance(&stiffer, &line) - 0.1).abs() < 1e-15);
        // It breaks at half the displacement: the other half of the area, three quarters of it, is
        // between them, except for the drop.
        let weaker = [[0.0, 0.0], [1.0, 2.0], [1.0 + 1e-9, 0.0], [1.1, 0.0]];
        assert!((distance(&weaker, &line) - 0.75).abs() < 1e-8);
        // Reversed: the area under the weaker one is 1, the area between them 3.
        assert!((distance(&line, &weaker) - 3.0).abs() < 1e-8);
        // Two lines that cross half-way: two triangles of a quarter each; the area under the second
        // is one half.
        let [up, down] = [[[0.0, 0.0], [1.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]];
        assert!((distance(&up, &down) - 1.0).abs() < 1e-15);
    }
}
