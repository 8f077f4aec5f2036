//! The mean of several curves (Platzer 2022, fig. 50).

use serde::{Deserialize, Serialize};

use crate::evaluation::EvaluatedSpecimen;
use crate::specimen::Specimen;
use crate::statistic::Statistic;

/// Points of a mean curve.
const POINTS: usize = 201;

/// A point of a mean curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// Crosshead travel from where the linear part has no force, m.
    pub displacement_m: f64,
    /// Mean force, N.
    pub load_n: f64,
    /// Standard deviation of the force of single specimens, N.
    pub standard_deviation_n: f64,
}

/// The mean curve of specimens, scaled to another one, up to their mean travel at failure: forces
/// are averaged at equal fractions of the travel at failure, so that the mean curve ends where
/// specimens fail on average, with their mean largest force. Length 201.
pub(crate) fn mean_curve(valid: &[&EvaluatedSpecimen], reference: &Specimen) -> Vec<CurvePoint> {
    let travels: Vec<f64> = valid.iter().map(|one| one.travel_at_failure_m).collect();
    let travel_m = Statistic::of(&travels).mean;
    let curves: Vec<Vec<f64>> = valid.iter().map(|one| forces(one, reference)).collect();
    let point = |at: usize| {
        let forces: Vec<f64> = curves.iter().map(|curve| curve[at]).collect();
        let force = Statistic::of(&forces);
        CurvePoint {
            displacement_m: travel_m * at as f64 / (POINTS - 1) as f64,
            load_n: force.mean,
            standard_deviation_n: force.standard_deviation,
        }
    };
    (0..POINTS).map(point).collect()
}

/// Forces of a specimen at equal distances of the travel, from where the fitted line has no force
/// to the largest force, N: means over a distance, or between the two rows around. Length 201.
fn forces(one: &EvaluatedSpecimen, reference: &Specimen) -> Vec<f64> {
    let factor = one.measured.specimen.force_factor(reference);
    let travel_m = &one.measured.curve.travel_m[..=one.regions.peak];
    let force_n = &one.regions.corrected_n[..=one.regions.peak];
    let step_m = one.travel_at_failure_m / (POINTS - 1) as f64;
    let force = |at: usize| {
        let x = one.regions.start_m + at as f64 * step_m;
        if at == POINTS - 1 {
            return factor * one.regions.largest_n;
        }
        let from = travel_m.partition_point(|other| *other < x - 0.5 * step_m);
        let to = travel_m.partition_point(|other| *other <= x + 0.5 * step_m);
        if from < to {
            return factor * force_n[from..to].iter().sum::<f64>() / (to - from) as f64;
        }
        factor * between(travel_m, force_n, from, x)
    };
    (0..POINTS).map(force).collect()
}

/// Value at x on the line between row `next` and the one before.
fn between(x: &[f64], y: &[f64], next: usize, at: f64) -> f64 {
    if next == 0 {
        return y[0];
    }
    if next == x.len() {
        return y[next - 1];
    }
    let part = (at - x[next - 1]) / (x[next] - x[next - 1]);
    y[next - 1] + part * (y[next] - y[next - 1])
}
