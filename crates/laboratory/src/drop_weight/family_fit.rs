//! The family of t_n.

use dem_physics::breakage::{USUAL_FAMILY_EXPONENT, passing};

use super::estimate::Estimate;
use super::sheet::DropWeightTest;
use crate::student::student_95;

/// Exponents between which the family is looked for.
const EXPONENTS: [f64; 2] = [0.1, 3.0];
/// Values of t10 between which the fineness of a test is looked for, and the steps of that.
const FINENESSES: [f64; 2] = [1e-9, 1.0 - 1e-9];
const STEPS: usize = 12;
/// Change of the exponent for a derivative.
const CHANGE: f64 = 1e-6;

/// How far one t_n of the family is off.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FamilyMisfit {
    /// n.
    pub n: f64,
    /// Number of tests that give it.
    pub tests: usize,
    /// Root of the mean square of measured minus that of the measured t10.
    pub rms: f64,
}

/// The exponent of the family, and the misfit of each n: the usual exponent where no family is
/// given.
///
/// All t_n of a test, t10 among them, scatter alike around the family at one fineness of the test,
/// which is fitted as well: an error of t10 does not shift the exponent. The interval takes each
/// test as one observation, as the errors of its t_n are not independent.
pub(super) fn fit_family(tests: &[DropWeightTest]) -> (Estimate, Vec<FamilyMisfit>) {
    let families: Vec<Vec<[f64; 2]>> = (tests.iter())
        .filter(|test| !test.family.is_empty())
        .filter_map(|test| {
            let t10 = test.t10.filter(|t10| *t10 > 0.0)?;
            Some([vec![[10.0, t10]], test.family.clone()].concat())
        })
        .collect();
    if families.is_empty() {
        return (Estimate::assumed(USUAL_FAMILY_EXPONENT), Vec::new());
    }
    let squares = |exponent: f64| -> f64 {
        let one = |family: &Vec<[f64; 2]>| {
            let fineness = fineness(family, exponent);
            residuals(family, exponent, fineness)
                .map(|off| off * off)
                .sum::<f64>()
        };
        families.iter().map(one).sum()
    };
    let exponent = lowest(EXPONENTS, &squares);
    let estimate = Estimate {
        interval: interval(&families, exponent),
        ..Estimate::fitted(exponent)
    };
    (estimate, misfits(&families, exponent))
}

/// Measured minus fitted t_n of a test.
fn residuals(family: &[[f64; 2]], exponent: f64, t10: f64) -> impl Iterator<Item = f64> {
    family
        .iter()
        .map(move |[n, share]| share - passing(exponent, *n, t10))
}

/// The t10 at which the family is nearest to what a test gave, by Gauss and Newton.
fn fineness(family: &[[f64; 2]], exponent: f64) -> f64 {
    let [least, most] = FINENESSES;
    let mut t10 = family[0][1].clamp(least, most);
    for _ in 0..STEPS {
        let (mut off, mut slopes) = (0.0, 0.0);
        for [n, share] in family {
            let passing = passing(exponent, *n, t10);
            let slope = slope(exponent, *n, t10);
            off += slope * (share - passing);
            slopes += slope * slope;
        }
        t10 = (t10 + off / slopes).clamp(least, most);
    }
    t10
}

/// Derivative of t_n by t10.
fn slope(exponent: f64, n: f64, t10: f64) -> f64 {
    let power = (9.0 / (n - 1.0)).powf(exponent);
    power * (1.0 - t10).powf(power - 1.0)
}

/// The 95 % interval: derivatives by the exponent without what the fineness takes up.
fn interval(families: &[Vec<[f64; 2]>], exponent: f64) -> Option<[f64; 2]> {
    let (mut curvature, mut variance) = (0.0, 0.0);
    for family in families {
        let t10 = fineness(family, exponent);
        let by_exponent: Vec<f64> = (family.iter())
            .map(|[n, _]| {
                let [low, high] =
                    [exponent - CHANGE, exponent + CHANGE].map(|one| passing(one, *n, t10));
                (high - low) / (2.0 * CHANGE)
            })
            .collect();
        let by_t10: Vec<f64> = family
            .iter()
            .map(|[n, _]| slope(exponent, *n, t10))
            .collect();
        let dot = |one: &[f64], other: &[f64]| -> f64 {
            one.iter().zip(other).map(|(one, other)| one * other).sum()
        };
        let part = dot(&by_exponent, &by_t10) / dot(&by_t10, &by_t10);
        let left: Vec<f64> = (by_exponent.iter().zip(&by_t10))
            .map(|(slope, taken)| slope - part * taken)
            .collect();
        let off: Vec<f64> = residuals(family, exponent, t10).collect();
        curvature += dot(&left, &left);
        variance += dot(&left, &off).powi(2);
    }
    let count = families.len();
    if count < 2 || curvature <= 0.0 {
        return None;
    }
    let few = count as f64 / (count - 1) as f64;
    let half = student_95(count - 1) * (few * variance).sqrt() / curvature;
    Some([exponent - half, exponent + half])
}

fn misfits(families: &[Vec<[f64; 2]>], exponent: f64) -> Vec<FamilyMisfit> {
    let mut ns: Vec<f64> = families.iter().flatten().map(|[n, _]| *n).collect();
    ns.retain(|n| *n != 10.0);
    ns.sort_by(f64::total_cmp);
    ns.dedup();
    let misfit = |n: f64| {
        let off = families.iter().filter_map(|family| {
            let share = family.iter().find(|[other, _]| *other == n)?[1];
            Some(share - passing(exponent, n, family[0][1]))
        });
        let squares: Vec<f64> = off.map(|off| off * off).collect();
        let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        FamilyMisfit {
            n,
            tests: squares.len(),
            rms,
        }
    };
    ns.into_iter().map(misfit).collect()
}

/// Where a function with a single minimum between these ends is lowest: golden section.
fn lowest(ends: [f64; 2], function: &dyn Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let [mut low, mut high] = ends;
    let mut inner = [high - ratio * (high - low), low + ratio * (high - low)];
    let mut values = inner.map(function);
    while high - low > 1e-9 {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [high - ratio * (high - low), inner[0]];
            values = [function(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + ratio * (high - low)];
            values = [values[1], function(inner[1])];
        }
    }
    f64::midpoint(low, high)
}
