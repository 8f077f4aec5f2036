//! The elastic part of a curve, by one rule for measured and for simulated curves.

use std::ops::Range;

use crate::fit::Line;

/// Fractions of the largest force between which the stiffness is the slope of the force: below,
/// specimens and pins settle; above, they break.
pub const ELASTIC: [f64; 2] = [0.2, 0.6];
/// Smallest number of rows for a slope.
const FEWEST_ROWS: usize = 3;

/// The rows from the first that reaches 20 % of the largest force, N, to the first that reaches
/// 60 %. None: too few for a slope.
pub fn elastic_rows(force_n: &[f64], largest_n: f64) -> Option<Range<usize>> {
    let [from, to] = ELASTIC.map(|fraction| {
        let level_n = fraction * largest_n;
        force_n.iter().position(|force| *force >= level_n)
    });
    let rows = from?..to?;
    (rows.len() >= FEWEST_ROWS).then_some(rows)
}

/// The line fitted to the force, N, over a displacement, m, in those rows, by least squares. None:
/// too few rows, or no displacement.
pub fn elastic_line(way_m: &[f64], force_n: &[f64], largest_n: f64) -> Option<Line> {
    let rows = elastic_rows(force_n, largest_n)?;
    let line = Line::fitted(&way_m[rows.clone()], &force_n[rows]);
    line.slope.is_finite().then_some(line)
}
