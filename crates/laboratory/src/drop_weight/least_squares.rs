//! Least squares with bounds: Levenberg 1944 and Marquardt 1963, with numerical derivatives.

use nalgebra::{DMatrix, DVector};

/// Most steps; a dozen are usual.
const MOST_STEPS: usize = 200;
/// Change of a value for its derivative, as a part of it, and the least size that this is part of.
const PART: f64 = 1e-6;
const LEAST_SIZE: f64 = 0.01;
/// A fit has ended when no value changes by more than this part.
const ENDED: f64 = 1e-11;

/// A value to fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unknown {
    /// First guess; the value unless it is free.
    pub(super) start: f64,
    /// Smallest value.
    pub(super) least: f64,
    pub(super) is_free: bool,
}

/// The values with the least sum of squares.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fitted {
    pub(super) values: Vec<f64>,
    /// Places of those that are free and not at their bound.
    pub(super) inner: Vec<usize>,
    /// Sum of the squares of the residuals.
    pub(super) squares: f64,
}

/// Fits the free values. `residuals`: of all points, for given values.
pub(super) fn least_squares(
    unknowns: &[Unknown],
    residuals: &dyn Fn(&[f64]) -> DVector<f64>,
) -> Fitted {
    let free: Vec<usize> = (0..unknowns.len())
        .filter(|at| unknowns[*at].is_free)
        .collect();
    let start = unknowns.iter().map(|one| one.start.max(one.least));
    let mut values: Vec<f64> = start.collect();
    let mut found = residuals(&values);
    let mut slopes = jacobian(&values, &free, residuals);
    let mut damping = 1e-3;
    for _ in 0..MOST_STEPS {
        let gradient = slopes.tr_mul(&found);
        let inner = inner(unknowns, &values, &free, &gradient);
        let Some(change) = step(&slopes, &gradient, &inner, damping) else {
            break;
        };
        let mut next = values.clone();
        let mut largest: f64 = 0.0;
        for (place, change) in inner.iter().zip(&change) {
            let at = free[*place];
            next[at] = (values[at] - change).max(unknowns[at].least);
            largest = largest.max((next[at] - values[at]).abs() / values[at].abs().max(LEAST_SIZE));
        }
        let after = residuals(&next);
        if after.norm_squared() < found.norm_squared() {
            (values, found) = (next, after);
            slopes = jacobian(&values, &free, residuals);
            damping = (0.1 * damping).max(1e-12);
        } else {
            damping *= 10.0;
        }
        if largest < ENDED {
            break;
        }
    }
    let inner = inner(unknowns, &values, &free, &slopes.tr_mul(&found));
    Fitted {
        inner: inner.into_iter().map(|place| free[place]).collect(),
        squares: found.norm_squared(),
        values,
    }
}

/// Derivatives of the residuals by the values at these places, a column for each.
pub(super) fn jacobian(
    values: &[f64],
    places: &[usize],
    residuals: &dyn Fn(&[f64]) -> DVector<f64>,
) -> DMatrix<f64> {
    let column = |at: &usize| {
        let change = PART * values[*at].abs().max(LEAST_SIZE);
        let moved = |change: f64| {
            let mut values = values.to_vec();
            values[*at] += change;
            residuals(&values)
        };
        (moved(change) - moved(-change)) / (2.0 * change)
    };
    let columns: Vec<DVector<f64>> = places.iter().map(column).collect();
    DMatrix::from_columns(&columns)
}

/// Places among the free values of those that are above their bound, or that a step would move off
/// it.
fn inner(
    unknowns: &[Unknown],
    values: &[f64],
    free: &[usize],
    gradient: &DVector<f64>,
) -> Vec<usize> {
    let is_inner = |place: &usize| {
        let at = free[*place];
        values[at] > unknowns[at].least || gradient[*place] < 0.0
    };
    (0..free.len()).filter(is_inner).collect()
}

/// How much less the inner values become in a damped step. None: the equations are singular.
fn step(
    slopes: &DMatrix<f64>,
    gradient: &DVector<f64>,
    inner: &[usize],
    damping: f64,
) -> Option<DVector<f64>> {
    let slopes = slopes.select_columns(inner);
    let mut product = slopes.tr_mul(&slopes);
    for at in 0..inner.len() {
        product[(at, at)] *= 1.0 + damping;
    }
    Some(product.cholesky()?.solve(&gradient.select_rows(inner)))
}
