//! The largest force of a curve, by one rule for measured and for simulated curves.

use crate::elastic::ELASTIC;
use crate::fit::{Line, noise};

/// Error that noise may leave in the largest force, as a fraction of it.
const EXACT: f64 = 1e-3;
/// Numbers of rows over which noise is averaged: at least, at most, and as a fraction of those from
/// the first that reaches 20 % of the largest force.
const FEWEST_ROWS: usize = 5;
const MOST_ROWS: usize = 50;
const MOST_OF_RISE: usize = 40;

/// The largest force of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestForce {
    /// Its row.
    pub row: usize,
    /// N.
    pub force_n: f64,
}

/// The row with the largest force, N, over a displacement, m, and its force: that of the row itself
/// where noise is less than a thousandth, otherwise that of a line fitted to the last rows up to
/// it, as many as leave an error of a thousandth, so that noise does not raise it. None: no rows.
pub fn largest_force(way_m: &[f64], force_n: &[f64]) -> Option<LargestForce> {
    let higher = |best: usize, row: usize| {
        if force_n[row] > force_n[best] {
            row
        } else {
            best
        }
    };
    let row = (0..force_n.len()).reduce(higher)?;
    let highest_n = force_n[row];
    let largest = |force_n: f64| Some(LargestForce { row, force_n });
    // The value of a line at the last of n rows scatters by two sigma over the root of n.
    let wanted = (2.0 * noise(force_n) / (EXACT * highest_n)).powi(2);
    let loaded = force_n.iter().position(|f| *f >= ELASTIC[0] * highest_n);
    let most = (row + 1 - loaded.unwrap_or(row)) / MOST_OF_RISE;
    let most = most.clamp(FEWEST_ROWS, MOST_ROWS).min(row + 1);
    if !(wanted > 1.0 && most >= FEWEST_ROWS) {
        return largest(highest_n);
    }
    let count = (wanted.min(MOST_ROWS as f64).ceil() as usize).clamp(FEWEST_ROWS, most);
    let rows = row + 1 - count..row + 1;
    if way_m[rows.start] == way_m[row] {
        return largest(highest_n);
    }
    largest(Line::fitted(&way_m[rows.clone()], &force_n[rows]).at(way_m[row]))
}
