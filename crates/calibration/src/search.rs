//! The next factors, from the results so far: secants of the logarithms.

use crate::case::{End, Round, Start};
use crate::response::Response;
use crate::unknown::Unknown;
use dem_laboratory::half_width;

/// Rounds of tests after which a calibration ends if all results are proportional to their numbers.
const MOST_ROUNDS: usize = 4;
/// Rounds at most for other results.
const MOST_ROUNDS_OF_OTHERS: usize = 10;
/// Rounds after which it ends, those without a result included.
const MOST_ROUNDS_AT_ALL: usize = 12;
/// Largest factor on the strength of bodies that do not break within the stroke.
pub(crate) const MUCH_WEAKER: f64 = 0.25;
/// Largest relative deviation of a mean that is accepted because its target is within the
/// confidence interval.
pub(crate) const FURTHEST_WITHIN_SCATTER: f64 = 0.05;
/// Smallest change of the logarithm of a factor from which the slope of a single result is taken.
const FEWEST_CHANGE: f64 = 0.1;
/// Range of the size of slopes of results that are not proportional.
const SIZES_OF_SLOPES: [f64; 2] = [0.1, 5.0];
/// Largest change of the logarithm of the factors of such results: in the first step, whose slope
/// is not known, and in others.
const CHANGES: [f64; 2] = [0.4, 1.0];
/// A result that follows its number less than this does not depend on it.
pub(crate) const FLAT: f64 = 0.05;
/// Largest factor on a number of the scene, and the inverse of the smallest.
pub(crate) const FURTHEST: f64 = 1e3;

/// What is to be done after a round.
#[derive(Debug, Clone, PartialEq)]
pub enum Step {
    /// Another round with these factors, one for each unknown.
    Try(Vec<f64>),
    /// Nothing: the round with this index is the result.
    Stop(usize, End),
}

/// The step after these rounds, at least one, that began with `start`.
pub fn next(unknowns: &[Unknown], start: Option<&Start>, rounds: &[Round]) -> Step {
    let last = rounds.len() - 1;
    let deviations = rounds[last].deviations(unknowns);
    let is_met = |(unknown, deviation): (&Unknown, &Option<f64>)| {
        deviation.is_some_and(|deviation| deviation.abs() <= unknown.tolerance)
    };
    if unknowns.iter().zip(&deviations).all(is_met) {
        return Step::Stop(last, End::Met);
    }
    let mut factors = rounds[last].factors.clone();
    let mut missing = None;
    let proportional = Response::of(unknowns, start, rounds).factors(unknowns, rounds);
    for (at, unknown) in unknowns.iter().enumerate() {
        match factor(unknown, rounds, at, proportional[at]) {
            Ok(factor) => factors[at] = factor,
            Err(Obstacle::Missing(problem, remedy)) => {
                missing.get_or_insert((problem, remedy));
            }
            Err(Obstacle::Final(problem, remedy)) => {
                return Step::Stop(best(unknowns, rounds), End::NotMet(problem, remedy));
            }
        }
    }
    // Rounds without a result say where to look, but not how near the target is.
    let has_all = |round: &&Round| !round.deviations(unknowns).contains(&None);
    let counted = rounds.iter().filter(has_all).count();
    let goes_on = counted < most_rounds(unknowns) && rounds.len() < MOST_ROUNDS_AT_ALL;
    // Another number may give the missing result: a stiffer body may break within the same stroke.
    if goes_on && factors != rounds[last].factors {
        return Step::Try(factors);
    }
    match missing {
        Some((problem, remedy)) => Step::Stop(best(unknowns, rounds), End::NotMet(problem, remedy)),
        None => stop(unknowns, rounds),
    }
}

fn most_rounds(unknowns: &[Unknown]) -> usize {
    if unknowns.iter().all(|unknown| unknown.is_proportional) {
        MOST_ROUNDS
    } else {
        MOST_ROUNDS_OF_OTHERS
    }
}

/// Why there is no next factor: problem and remedy.
enum Obstacle {
    /// Whatever the other numbers are.
    Final(String, String),
    /// There is no result, which another number may change.
    Missing(String, String),
}

/// The next factor of the unknown `at`, or why there is none. `proportional`: what it is for a
/// proportional one.
fn factor(
    unknown: &Unknown,
    rounds: &[Round],
    at: usize,
    proportional: Option<f64>,
) -> Result<f64, Obstacle> {
    let last = &rounds[rounds.len() - 1];
    let old = last.factors[at];
    let name = &unknown.result;
    let Some(mean) = last.mean(at) else {
        return weaker(unknown, last, at);
    };
    let wanted = (unknown.target / mean).ln();
    // As near as this, scatter is larger than what a change would improve.
    if wanted.abs() <= 0.5 * unknown.tolerance {
        return Ok(old);
    }
    let slope = slope(rounds, at);
    if slope.is_some_and(|slope| slope.abs() < FLAT || (unknown.is_proportional && slope < 0.0)) {
        let problem = format!("the {name} hardly follows {}", unknown.numbers[0].path);
        let remedy = "something else determines it, such as contacts at pins or plates: take smaller spheres, correct the target, or calibrate the modulus of the specimen itself (--modulus specimen)";
        return Err(Obstacle::Final(problem, remedy.to_owned()));
    }
    let new = proportional.unwrap_or_else(|| {
        let change = match slope {
            None => wanted.clamp(-CHANGES[0], CHANGES[0]),
            Some(slope) => {
                let size = slope.abs().clamp(SIZES_OF_SLOPES[0], SIZES_OF_SLOPES[1]);
                (wanted / size * slope.signum()).clamp(-CHANGES[1], CHANGES[1])
            }
        };
        old * change.exp()
    });
    if !(1.0 / FURTHEST..=FURTHEST).contains(&new) {
        let problem = format!(
            "the target of the {name} is out of reach: {} would be {new:.3e} times that of the scene",
            unknown.numbers[0].path
        );
        let remedy = "check the target and its unit".to_owned();
        return Err(Obstacle::Final(problem, remedy));
    }
    Ok(new)
}

/// The factor after a round in which not all bodies break.
fn weaker(unknown: &Unknown, last: &Round, at: usize) -> Result<f64, Obstacle> {
    let name = &unknown.result;
    let Some((least, whole)) = last.least_mean(at) else {
        let problem = format!("no test gave the {name}");
        let remedy = "see what dem-run says of the test itself".to_owned();
        return Err(Obstacle::Missing(problem, remedy));
    };
    if least < unknown.target {
        let all = last.trials.len();
        let which = match whole == all {
            true => "the bodies do not break".to_owned(),
            false => format!("{whole} of {all} bodies do not break"),
        };
        let problem = format!(
            "{which}: at the end of the stroke the {name} is {:.3} of its target",
            least / unknown.target
        );
        return Err(Obstacle::Missing(
            problem,
            "lengthen test.stroke".to_owned(),
        ));
    }
    let factor = unknown.target / least;
    // If none breaks, how strong they are is not known: the stroke ended first.
    let factor = match whole == last.trials.len() {
        true => factor.min(MUCH_WEAKER),
        false => factor,
    };
    Ok(last.factors[at] * factor)
}

/// Slope of ln(mean result) over ln(factor), from the last two rounds that differ enough.
fn slope(rounds: &[Round], at: usize) -> Option<f64> {
    let last = &rounds[rounds.len() - 1];
    let mean = last.mean(at)?;
    let before = rounds[..rounds.len() - 1].iter().rev();
    let slope = |round: &Round| {
        let change = (last.factors[at] / round.factors[at]).ln();
        let followed = (mean / round.mean(at)?).ln();
        (change.abs() >= FEWEST_CHANGE).then(|| followed / change)
    };
    before.into_iter().find_map(slope)
}

/// The round with the smallest largest ratio of deviation to tolerance.
fn best(unknowns: &[Unknown], rounds: &[Round]) -> usize {
    let apart = |round: &Round| {
        let deviations = round.deviations(unknowns);
        let of = |(unknown, deviation): (&Unknown, Option<f64>)| {
            deviation.map_or(f64::INFINITY, |deviation| {
                deviation.abs() / unknown.tolerance
            })
        };
        unknowns.iter().zip(deviations).map(of).fold(0.0, f64::max)
    };
    // Of equal ones the last.
    let all = rounds.iter().enumerate().rev();
    let nearest = all.min_by(|(_, a), (_, b)| apart(a).total_cmp(&apart(b)));
    nearest.map_or(0, |(at, _)| at)
}

/// The end after the last round.
fn stop(unknowns: &[Unknown], rounds: &[Round]) -> Step {
    let at = best(unknowns, rounds);
    let round = &rounds[at];
    let outside = unknowns.iter().enumerate().find(|(at, unknown)| {
        let statistic = round.statistic(*at);
        !statistic.is_some_and(|statistic| {
            let off = (statistic.mean - unknown.target).abs();
            let within = half_width(&statistic).unwrap_or(0.0);
            let within = within.min(FURTHEST_WITHIN_SCATTER * unknown.target);
            off <= within.max(unknown.tolerance * unknown.target)
        })
    });
    let end = match outside {
        None => End::WithinScatter,
        Some((n, unknown)) => {
            let count = rounds.len();
            let problem = match round.mean(n) {
                Some(mean) => format!(
                    "the {} is {:.2} % from its target after {count} rounds",
                    unknown.result,
                    100.0 * (mean / unknown.target - 1.0)
                ),
                None => format!(
                    "after {count} rounds not all tests give the {}",
                    unknown.result
                ),
            };
            let remedy =
                "take more packings (--packings), or smaller spheres: their strengths scatter less";
            End::NotMet(problem, remedy.to_owned())
        }
    };
    Step::Stop(at, end)
}
