//! How proportional results follow the numbers: the matrix of d ln(result)/d ln(factor), corrected
//! by each round as by Broyden.

use nalgebra::{DMatrix, DVector};

use crate::case::{Round, Start};
use crate::unknown::Unknown;

/// Range of the slope of a result over its own number: contacts at pins take a part of the
/// deformation.
const OWN: [f64; 2] = [0.25, 2.0];
/// Largest slope over the number of another result.
const OTHER: f64 = 0.5;
/// Changes of factors below this multiple of the standard error of the change of a mean say nothing
/// of a slope.
const ABOVE_SCATTER: f64 = 3.0;
/// Nor do changes below this.
const LEAST: f64 = 0.01;
/// The same, in tolerances, where one packing says nothing of the scatter.
const TOLERANCES: f64 = 5.0;
/// Weight of a round beside that of the next one as long as all results lie on one side of the
/// target: what earlier rounds say has not led there.
const EARLIER: f64 = 0.5;

/// Slopes of the proportional results.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    /// d ln(result of the row)/d ln(factor of the column); rows and columns of others are those of
    /// the identity.
    slopes: DMatrix<f64>,
}

impl Response {
    /// From the slopes at the start, 1 without one, and the rounds since.
    pub(crate) fn of(unknowns: &[Unknown], start: Option<&Start>, rounds: &[Round]) -> Self {
        let count = unknowns.len();
        let first = |at: usize| start.map_or(1.0, |start| start.slopes[at]);
        let own = DVector::from_fn(count, |at, _| match unknowns[at].is_proportional {
            true => first(at).clamp(OWN[0], OWN[1]),
            false => 1.0,
        });
        let mut response = Self {
            slopes: DMatrix::from_diagonal(&own),
        };
        for pair in rounds.windows(2) {
            response.correct(unknowns, &pair[0], &pair[1]);
        }
        response
    }

    /// Corrects the slopes of each result so that they explain its change between two rounds.
    fn correct(&mut self, unknowns: &[Unknown], before: &Round, after: &Round) {
        let count = unknowns.len();
        let change = DVector::from_fn(count, |at, _| match unknowns[at].is_proportional {
            true => (after.factors[at] / before.factors[at]).ln(),
            false => 0.0,
        });
        let size = change.amax();
        for (row, unknown) in unknowns
            .iter()
            .enumerate()
            .filter(|(_, u)| u.is_proportional)
        {
            let Some((followed, scatter)) = followed(unknown, before, after, row) else {
                continue;
            };
            if size < LEAST.max(scatter) {
                continue;
            }
            let wrong = followed - (self.slopes.row(row) * &change)[0];
            let correction = change.transpose() * (wrong / change.norm_squared());
            for column in 0..count {
                let slope = self.slopes[(row, column)] + correction[column];
                self.slopes[(row, column)] = match row == column {
                    true => slope.clamp(OWN[0], OWN[1]),
                    false => slope.clamp(-OTHER, OTHER),
                };
            }
        }
    }

    /// Changes of the logarithms of the factors that change those of the results by `wanted`; 0
    /// where that is None.
    fn changes(&self, wanted: &[Option<f64>]) -> Vec<f64> {
        let known: Vec<usize> = (0..wanted.len())
            .filter(|at| wanted[*at].is_some())
            .collect();
        let mut changes = vec![0.0; wanted.len()];
        if known.is_empty() {
            return changes;
        }
        let slopes = self.slopes.select_rows(&known).select_columns(&known);
        let right = DVector::from_iterator(known.len(), wanted.iter().flatten().copied());
        let solved = slopes.lu().solve(&right).unwrap_or(right);
        for (at, change) in known.iter().zip(&solved) {
            changes[*at] = *change;
        }
        changes
    }

    /// Factors with which proportional results are met: the mean of what the rounds say, those near
    /// the target the most, as strengths scatter from round to round; also the last rounds more, as
    /// long as all lie on one side of the target. None: not a proportional result, or no round has
    /// it.
    pub(crate) fn factors(&self, unknowns: &[Unknown], rounds: &[Round]) -> Vec<Option<f64>> {
        let wanted = |round: &Round| -> Vec<Option<f64>> {
            let unknowns = unknowns.iter().enumerate();
            unknowns
                .map(|(at, unknown)| {
                    let mean = round.mean(at).filter(|_| unknown.is_proportional)?;
                    Some((unknown.target / mean).ln())
                })
                .collect()
        };
        let wanted: Vec<Vec<Option<f64>>> = rounds.iter().map(wanted).collect();
        let changes: Vec<Vec<f64>> = wanted.iter().map(|wanted| self.changes(wanted)).collect();
        let factor = |(at, unknown): (usize, &Unknown)| {
            let of_rounds = || wanted.iter().filter_map(|of_round| of_round[at]);
            let is_one_sided =
                of_rounds().all(|wanted| wanted > 0.0) || of_rounds().all(|wanted| wanted < 0.0);
            let earlier = if is_one_sided { EARLIER } else { 1.0 };
            let (mut sum, mut weights) = (0.0, 0.0);
            for (which, round) in rounds.iter().enumerate() {
                let Some(wanted) = wanted[which][at] else {
                    continue;
                };
                let weight = 1.0 / (1.0 + (wanted / unknown.tolerance).powi(2));
                let says = round.factors[at].ln() + changes[which][at];
                (sum, weights) = (earlier * sum + weight * says, earlier * weights + weight);
            }
            (weights > 0.0).then(|| (sum / weights).exp())
        };
        unknowns.iter().enumerate().map(factor).collect()
    }
}

/// Change of ln(mean) of a result between two rounds, and the least change of factors that says
/// something of its slope. None: not all packings have the result in both.
fn followed(unknown: &Unknown, before: &Round, after: &Round, at: usize) -> Option<(f64, f64)> {
    let followed = (after.mean(at)? / before.mean(at)?).ln();
    let pairs = before.trials.iter().zip(&after.trials);
    let of =
        |round: &Option<crate::case::Trial>| round.as_ref().and_then(|trial| trial.results[at]);
    let changes: Vec<f64> = pairs
        .filter_map(|(before, after)| Some((of(after)? / of(before)?).ln()))
        .collect();
    let statistic = dem_laboratory::Statistic::of(&changes);
    let scatter = match statistic.count {
        0 | 1 => TOLERANCES * unknown.tolerance,
        count => ABOVE_SCATTER * statistic.standard_deviation / (count as f64).sqrt(),
    };
    Some((followed, scatter))
}
