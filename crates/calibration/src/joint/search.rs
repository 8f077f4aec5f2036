//! The next factors of a calibration by several tests: weighted least squares of all targets.

use nalgebra::DMatrix;

use super::response::{PROBE, base, has_all, main_rounds, probed, response};
use super::squares::weighted_step;
use super::state::{Aim, Joint};
use crate::case::{End, Round, Trial};
use crate::search::{FLAT, FURTHEST, FURTHEST_WITHIN_SCATTER, MUCH_WEAKER, Step};
use dem_laboratory::half_width;

/// Rounds with all results after which a calibration ends: this many, and so many more for each
/// unknown. The probes are not counted.
const ROUNDS: [usize; 2] = [4, 2];
/// Rounds after which it ends, those without a result included and the probes not.
const MOST_ROUNDS_AT_ALL: usize = 14;
/// Fewest rounds before targets are said to contradict each other.
const FEWEST_ROUNDS: usize = 3;
/// Largest change of the logarithm of a factor.
const LONGEST: f64 = 1.0;
/// Factors that differ by less than this have been tried.
const SAME: f64 = 1e-3;
/// Part of the sum of squares that has to be left for another round to be worth while.
const HARDLY_LESS: f64 = 0.8;
/// Part of the sum of squares that no numbers take away if targets contradict each other.
const LEFT: f64 = 0.5;

/// The step after the rounds of a calibration, at least one.
pub fn next_of_joint(joint: &Joint) -> Step {
    let last = joint.rounds.len() - 1;
    if is_within(joint, &joint.rounds[last], |aim, _| aim.tolerance) {
        return Step::Stop(last, End::Met);
    }
    let probes = probed(joint);
    if let Some(base) = base(joint)
        && let Some(probe) = probes.get(last - base)
    {
        let mut factors = joint.rounds[base].factors.clone();
        factors[*probe] *= PROBE.exp();
        return Step::Try(factors);
    }
    let slopes = response(joint);
    let main = main_rounds(joint);
    let counted = main.iter().filter(|round| has_all(joint, round)).count();
    let most = ROUNDS[0] + ROUNDS[1] * joint.unknowns.len();
    let is_at_best = counted >= FEWEST_ROUNDS && least_left(joint, &slopes) > HARDLY_LESS;
    let goes_on = counted < most && main.len() < MOST_ROUNDS_AT_ALL && !is_at_best;
    let factors = proposed(joint, &slopes, &main);
    let is_tried = |round: &&Round| {
        let pairs = round.factors.iter().zip(&factors);
        pairs.into_iter().all(|(a, b)| (a / b).ln().abs() < SAME)
    };
    match goes_on && !joint.rounds.iter().any(|round| is_tried(&round)) {
        true => Step::Try(factors),
        false => stop(joint, &slopes),
    }
}

/// Whether the mean of every aim is within a relative deviation from its target.
fn is_within(joint: &Joint, round: &Round, most: impl Fn(&Aim, usize) -> f64) -> bool {
    joint.aims.iter().enumerate().all(|(at, aim)| {
        let mean = joint.statistic(round, at).map(|statistic| statistic.mean);
        mean.is_some_and(|mean| (mean / aim.target - 1.0).abs() <= most(aim, at))
    })
}

/// Sum of the squares of ln(target/mean) over the tolerance; infinite without all results.
fn squares(joint: &Joint, round: &Round) -> f64 {
    let of = |(at, aim): (usize, &Aim)| {
        let wanted = joint.wanted(round, at);
        wanted.map_or(f64::INFINITY, |wanted| (wanted / aim.tolerance).powi(2))
    };
    joint.aims.iter().enumerate().map(of).sum()
}

/// The round with the smallest sum of squares; of equal ones the last.
fn best(joint: &Joint) -> usize {
    let all = joint.rounds.iter().enumerate().rev();
    let nearest = all.min_by(|(_, a), (_, b)| squares(joint, a).total_cmp(&squares(joint, b)));
    nearest.map_or(0, |(at, _)| at)
}

/// Sum of squares that the best step from the best round leaves, over that of this round. 0: there
/// is no such round, or there are as many unknowns as targets, which can all be met as far as the
/// slopes are right.
fn least_left(joint: &Joint, slopes: &DMatrix<f64>) -> f64 {
    if joint.aims.len() == joint.unknowns.len() {
        return 0.0;
    }
    let round = &joint.rounds[best(joint)];
    let wanted: Option<Vec<f64>> = (0..joint.aims.len())
        .map(|at| joint.wanted(round, at))
        .collect();
    let Some(wanted) = wanted else { return 0.0 };
    let tolerances: Vec<f64> = joint.aims.iter().map(|aim| aim.tolerance).collect();
    let step = weighted_step(slopes, &wanted, &tolerances);
    let left = slopes * step;
    let rows = wanted.iter().zip(&left).zip(&tolerances);
    let sum: f64 = rows
        .map(|((wanted, got), of)| ((wanted - got) / of).powi(2))
        .sum();
    sum / squares(joint, round)
}

/// The next factors: the mean of what the rounds with all results say, those near the targets the
/// most, as strengths scatter from round to round; what the last round says if it lacks some.
fn proposed(joint: &Joint, slopes: &DMatrix<f64>, main: &[&Round]) -> Vec<f64> {
    let last = main[main.len() - 1];
    let whole: Vec<&Round> = match has_all(joint, last) {
        true => (main.iter().copied())
            .filter(|round| has_all(joint, round))
            .collect(),
        false => vec![last],
    };
    let mut sums = vec![0.0; joint.unknowns.len()];
    let mut weights = 0.0;
    for round in whole {
        let step = step_from(joint, slopes, round);
        let far = squares(joint, round) / joint.aims.len() as f64;
        let weight = match far.is_finite() {
            true => 1.0 / (1.0 + far),
            false => 1.0,
        };
        for ((sum, factor), step) in sums.iter_mut().zip(&round.factors).zip(step) {
            *sum += weight * (factor.ln() + step);
        }
        weights += weight;
    }
    let limited = sums.iter().zip(&joint.unknowns);
    limited
        .map(|(sum, unknown)| {
            let most = unknown.largest.min(FURTHEST);
            (sum / weights).exp().clamp(1.0 / FURTHEST, most)
        })
        .collect()
}

/// The step from a round, by the results that it has.
fn step_from(joint: &Joint, slopes: &DMatrix<f64>, round: &Round) -> Vec<f64> {
    let known: Vec<(usize, f64)> = (0..joint.aims.len())
        .filter_map(|at| {
            let wanted = joint.wanted(round, at);
            Some((at, wanted.or_else(|| weaker(joint, round, at))?))
        })
        .collect();
    let rows: Vec<usize> = known.iter().map(|(at, _)| *at).collect();
    let wanted: Vec<f64> = known.iter().map(|(_, wanted)| *wanted).collect();
    let tolerances: Vec<f64> = rows.iter().map(|at| joint.aims[*at].tolerance).collect();
    let step = weighted_step(&slopes.select_rows(&rows), &wanted, &tolerances);
    let limited = step.iter().map(|step| step.clamp(-LONGEST, LONGEST));
    limited.collect()
}

/// Wanted change of the logarithm of a result that not all packings have, as they are too strong.
/// None: they may be too weak.
fn weaker(joint: &Joint, round: &Round, aim: usize) -> Option<f64> {
    let least = least_mean(joint, round, aim)?;
    (least >= joint.aims[aim].target)
        .then(|| (joint.aims[aim].target / least).min(MUCH_WEAKER).ln())
}

/// A value that the mean of an aim is at least.
fn least_mean(joint: &Joint, round: &Round, aim: usize) -> Option<f64> {
    let trials = round.trials[joint.trials_of(joint.aims[aim].test)].iter();
    let of = |trial: &Trial| trial.results[aim].or(trial.at_least[aim]);
    let bounds: Option<Vec<f64>> = trials.map(|trial| of(trial.as_ref()?)).collect();
    let bounds = bounds.filter(|bounds| !bounds.is_empty())?;
    Some(bounds.iter().sum::<f64>() / bounds.len() as f64)
}

/// The end after the last round.
fn stop(joint: &Joint, slopes: &DMatrix<f64>) -> Step {
    let at = best(joint);
    let round = &joint.rounds[at];
    if is_within(joint, round, |aim, _| aim.tolerance) {
        return Step::Stop(at, End::Met);
    }
    let interval = |aim: &Aim, at: usize| {
        let half = joint.statistic(round, at).and_then(|one| half_width(&one));
        let within = half.unwrap_or(0.0) / aim.target;
        within.min(FURTHEST_WITHIN_SCATTER).max(aim.tolerance)
    };
    if is_within(joint, round, interval) {
        return Step::Stop(at, End::WithinScatter);
    }
    let missing = (0..joint.aims.len()).find_map(|aim| missing(joint, round, aim));
    let (problem, remedy) = missing
        .or_else(|| unmoved(joint, slopes, round))
        .unwrap_or_else(|| apart(joint, slopes, round));
    Step::Stop(at, End::NotMet(problem, remedy))
}

/// Problem and remedy of an aim that not all tests give.
fn missing(joint: &Joint, round: &Round, at: usize) -> Option<(String, String)> {
    if joint.wanted(round, at).is_some() {
        return None;
    }
    let aim = &joint.aims[at];
    let scene = &joint.tests[aim.test].scene;
    Some(match least_mean(joint, round, at) {
        Some(least) => (
            format!(
                "{scene}: not all bodies break: at the end of the stroke the {} is {:.3} of its target",
                aim.result,
                least / aim.target
            ),
            "lengthen test.stroke of this scene".to_owned(),
        ),
        None => (
            format!("{scene}: not all tests gave the {}", aim.result),
            "see what dem-run says of the test itself".to_owned(),
        ),
    })
}

/// Problem and remedy of an aim that no free number moves.
fn unmoved(joint: &Joint, slopes: &DMatrix<f64>, round: &Round) -> Option<(String, String)> {
    let at = (0..joint.aims.len()).find(|at| {
        let wanted = joint.wanted(round, *at).unwrap_or(0.0);
        let is_flat = slopes.row(*at).amax() < FLAT;
        is_flat && wanted.abs() > joint.aims[*at].tolerance
    })?;
    let aim = &joint.aims[at];
    Some((
        format!(
            "{}: no free number moves the {}",
            joint.tests[aim.test].scene, aim.result
        ),
        "free a number that determines it (--free), or remove the target".to_owned(),
    ))
}

/// Problem and remedy of targets that are not met: how far each of them is off.
fn apart(joint: &Joint, slopes: &DMatrix<f64>, round: &Round) -> (String, String) {
    let off = |(at, aim): (usize, &Aim)| {
        let mean = joint.statistic(round, at)?.mean;
        let scene = &joint.tests[aim.test].scene;
        let off = 100.0 * (mean / aim.target - 1.0);
        Some(format!("{scene}: {} {off:+.1} %", aim.result))
    };
    let all: Vec<String> = joint.aims.iter().enumerate().filter_map(off).collect();
    let all = all.join(", ");
    if least_left(joint, slopes) > LEFT {
        return (
            format!("the targets contradict each other; the nearest numbers leave {all}"),
            "free another number that moves some of them and not others (--free), correct a target, or take more packings, whose means scatter less"
                .to_owned(),
        );
    }
    (
        format!(
            "the targets are not met after {} rounds: {all}",
            joint.rounds.len()
        ),
        "take more packings (--packings), or smaller spheres: their strengths scatter less"
            .to_owned(),
    )
}
