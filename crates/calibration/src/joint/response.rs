//! How the results of all tests follow the numbers: the matrix of d ln(result)/d ln(factor), from
//! statics and closed forms, probes, and each round since, as by Broyden.

use dem_laboratory::Statistic;
use nalgebra::{DMatrix, DVector};

use super::state::Joint;
use crate::case::{Round, Trial};

/// Change of the logarithm of a factor in a probe.
pub(super) const PROBE: f64 = 0.2;
/// Largest difference of a slope from statics or a closed form, and size of others.
const FURTHEST: f64 = 0.75;
const STEEPEST: f64 = 5.0;
/// Changes of factors below this multiple of the standard error of the change of a mean say nothing
/// of a slope; nor do changes below the least, and those below some tolerances where one packing
/// says nothing of the scatter.
const ABOVE_SCATTER: f64 = 3.0;
const LEAST: f64 = 0.01;
const TOLERANCES: f64 = 5.0;

/// Unknowns whose slopes neither statics nor a closed form knows: each has a round of its own.
pub(super) fn probed(joint: &Joint) -> Vec<usize> {
    let is_unknown = |at: &usize| joint.aims.iter().any(|aim| aim.slopes[*at].is_none());
    (0..joint.unknowns.len()).filter(is_unknown).collect()
}

/// The first round with all results, after which the probes come. None: there is none yet.
pub(super) fn base(joint: &Joint) -> Option<usize> {
    (joint.rounds.iter()).position(|round| has_all(joint, round))
}

/// Whether every packing has its results in a round.
pub(super) fn has_all(joint: &Joint, round: &Round) -> bool {
    (0..joint.aims.len()).all(|aim| joint.wanted(round, aim).is_some())
}

/// Rounds that are no probes, in order.
pub(super) fn main_rounds(joint: &Joint) -> Vec<&Round> {
    let probes = match base(joint) {
        Some(base) => base + 1..base + 1 + probed(joint).len(),
        None => 0..0,
    };
    let rounds = joint.rounds.iter().enumerate();
    let main = rounds.filter(|(at, _)| !probes.contains(at));
    main.map(|(_, round)| round).collect()
}

/// The matrix: a row for each aim, a column for each unknown.
pub(super) fn response(joint: &Joint) -> DMatrix<f64> {
    let first = |row: usize, column: usize| joint.aims[row].slopes[column];
    let mut slopes = DMatrix::from_fn(joint.aims.len(), joint.unknowns.len(), |row, column| {
        first(row, column).unwrap_or(0.0)
    });
    if let Some(base) = base(joint) {
        for (number, column) in probed(joint).into_iter().enumerate() {
            let Some(probe) = joint.rounds.get(base + 1 + number) else {
                continue;
            };
            for row in 0..joint.aims.len() {
                if let Some((followed, _)) = followed(joint, &joint.rounds[base], probe, row) {
                    slopes[(row, column)] = followed / PROBE;
                }
            }
        }
    }
    for pair in main_rounds(joint).windows(2) {
        correct(joint, &mut slopes, pair[0], pair[1]);
    }
    slopes
}

/// Corrects the slopes of each result so that they explain its change between two rounds.
fn correct(joint: &Joint, slopes: &mut DMatrix<f64>, before: &Round, after: &Round) {
    let change = DVector::from_fn(joint.unknowns.len(), |at, _| {
        (after.factors[at] / before.factors[at]).ln()
    });
    let size = change.amax();
    for row in 0..joint.aims.len() {
        let Some((followed, scatter)) = followed(joint, before, after, row) else {
            continue;
        };
        if size < LEAST.max(scatter) {
            continue;
        }
        let wrong = followed - (slopes.row(row) * &change)[0];
        for column in 0..joint.unknowns.len() {
            let slope = slopes[(row, column)] + change[column] * wrong / change.norm_squared();
            slopes[(row, column)] = match joint.aims[row].slopes[column] {
                Some(first) => slope.clamp(first - FURTHEST, first + FURTHEST),
                None => slope.clamp(-STEEPEST, STEEPEST),
            };
        }
    }
}

/// Change of ln(mean) of an aim between two rounds, and the least change of factors that says
/// something of its slope. None: not all packings have it in both.
fn followed(joint: &Joint, before: &Round, after: &Round, aim: usize) -> Option<(f64, f64)> {
    let followed = joint.wanted(before, aim)? - joint.wanted(after, aim)?;
    let of = |trial: &Option<Trial>| trial.as_ref()?.results[aim];
    let change = |at: usize| Some((of(&after.trials[at])? / of(&before.trials[at])?).ln());
    let trials = joint.trials_of(joint.aims[aim].test);
    let changes: Vec<f64> = trials.filter_map(change).collect();
    let statistic = Statistic::of(&changes);
    let scatter = match statistic.count {
        0 | 1 => TOLERANCES * joint.aims[aim].tolerance,
        count => ABOVE_SCATTER * statistic.standard_deviation / (count as f64).sqrt(),
    };
    Some((followed, scatter))
}
