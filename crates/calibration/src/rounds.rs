//! Rounds of tests: every packing once with the same numbers.

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use dem_io::Result;
use dem_laboratory::Statistic;
use serde::{Deserialize, Serialize};

use crate::search::{End, Step, next};
use crate::unknown::Unknown;

/// The test of one packing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// The result of each unknown, in its unit. None: the test did not give it.
    pub results: Vec<Option<f64>>,
    /// Where there is no result, a value that it is at least, in its unit: the stress at which the
    /// body was still whole. One for each unknown.
    pub at_least: Vec<Option<f64>>,
    /// Displacement, m, and load, N.
    pub curve: Vec<[f64; 2]>,
    /// Reasons to doubt the test, a sentence each.
    pub doubts: Vec<String>,
    /// Number of bonds that broke before the largest load.
    pub broken_at_peak: usize,
    /// Run time, s.
    pub wall_s: f64,
}

/// One test of each packing with the same factors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Round {
    /// Factor on the numbers of each unknown.
    pub factors: Vec<f64>,
    /// One for each packing; None: not done yet.
    pub trials: Vec<Option<Trial>>,
}

/// The first factors, from tests without time steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Factor on the numbers of each unknown.
    pub factors: Vec<f64>,
    /// Number of tests without steps.
    pub tests: usize,
    /// Run time, s.
    pub wall_s: f64,
}

/// A calibration of one set of packings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// Its name: the sizes of the spheres. Empty: there is only one.
    pub name: String,
    /// Particles of the first packing.
    pub particles: usize,
    /// Bonds of the first packing.
    pub bonds: usize,
    /// Smallest extent of the body over the mean diameter of its spheres.
    pub spheres_across: f64,
    /// The first factors. None: 1.
    pub start: Option<Start>,
    /// The rounds.
    pub rounds: Vec<Round>,
    /// The round that is the result, and how it ended. None: it has not ended.
    pub end: Option<(usize, End)>,
    /// The test of the first packing with the numbers of the result at twice the rate. None: not
    /// done.
    pub at_twice_the_rate: Option<Trial>,
    /// Why there is no such test although the scene asks for it.
    pub rate_problem: Option<String>,
}

/// Does the test of a packing, given by its number from 0, with a factor on the numbers of each
/// unknown.
pub type TestFunction<'a> = dyn Fn(&[f64], usize) -> Result<Trial> + Sync + 'a;

impl Round {
    /// Mean and scatter of a result. None: no packing has it.
    pub fn statistic(&self, unknown: usize) -> Option<Statistic> {
        let trials = self.trials.iter().flatten();
        let values: Vec<f64> = trials.filter_map(|trial| trial.results[unknown]).collect();
        // A mean over some of the packings only is not that of all.
        (values.len() == self.trials.len()).then(|| Statistic::of(&values))
    }

    /// Mean of a result.
    pub fn mean(&self, unknown: usize) -> Option<f64> {
        self.statistic(unknown).map(|statistic| statistic.mean)
    }

    /// (mean - target)/target of each unknown.
    pub fn deviations(&self, unknowns: &[Unknown]) -> Vec<Option<f64>> {
        let of = |(at, unknown): (usize, &Unknown)| {
            self.mean(at).map(|mean| mean / unknown.target - 1.0)
        };
        unknowns.iter().enumerate().map(of).collect()
    }

    /// The largest value that a result of a packing is at least, if there are any.
    pub(crate) fn largest_bound(&self, unknown: usize) -> Option<f64> {
        let trials = self.trials.iter().flatten();
        let bounds = trials.filter_map(|trial| trial.results[unknown].or(trial.at_least[unknown]));
        bounds.reduce(f64::max)
    }
}

impl Case {
    /// The round that is the result, or the last one.
    pub fn result(&self) -> Option<&Round> {
        match &self.end {
            Some((at, _)) => self.rounds.get(*at),
            None => self.rounds.last(),
        }
    }

    /// True if its targets are met, at least within the scatter of the packings.
    pub fn is_met(&self) -> bool {
        matches!(&self.end, Some((_, End::Met | End::WithinScatter)))
    }

    /// Problem and remedy of a target that is not met.
    pub fn problem(&self) -> Option<(String, String)> {
        match &self.end {
            Some((_, End::NotMet(problem, remedy))) => Some((problem.clone(), remedy.clone())),
            _ => None,
        }
    }

    /// True if the test at twice the rate has been done, or has failed.
    pub fn has_rate_check(&self) -> bool {
        self.at_twice_the_rate.is_some() || self.rate_problem.is_some()
    }

    /// Run time of all tests, s, and their number.
    pub fn cost(&self) -> (f64, usize) {
        let trials = || {
            self.rounds
                .iter()
                .flat_map(|round| round.trials.iter().flatten())
        };
        (trials().map(|trial| trial.wall_s).sum(), trials().count())
    }
}

/// Does rounds of tests, from the first factors of `case`, until the targets are met or cannot be
/// met. Rounds that `case` already has
/// are not repeated. `workers` tests run at a time; `save` is called after every test.
///
/// # Errors
/// Those of the tests and of `save`; the tests that are finished are in `case`.
pub fn calibrate(
    unknowns: &[Unknown],
    packings: usize,
    case: &mut Case,
    workers: usize,
    test: &TestFunction<'_>,
    save: &(dyn Fn(&Case) -> Result<()> + Sync),
) -> Result<()> {
    let start = case.start.as_ref().map(|start| start.factors.clone());
    let mut factors = start.unwrap_or_else(|| vec![1.0; unknowns.len()]);
    let mut at = 0;
    while case.end.is_none() {
        if at == case.rounds.len() {
            case.rounds.push(Round {
                factors: factors.clone(),
                trials: vec![None; packings],
            });
        }
        do_round(case, at, workers, test, save)?;
        match next(unknowns, &case.rounds[..=at]) {
            Step::Try(new) => factors = new,
            Step::Stop(best, end) => case.end = Some((best, end)),
        }
        at += 1;
    }
    save(case)
}

/// Does the tests of a round that are not done, some at a time.
fn do_round(
    case: &mut Case,
    at: usize,
    workers: usize,
    test: &TestFunction<'_>,
    save: &(dyn Fn(&Case) -> Result<()> + Sync),
) -> Result<()> {
    let round = &case.rounds[at];
    let factors = round.factors.clone();
    let trials = round.trials.iter().enumerate();
    let left: Vec<usize> = trials
        .filter(|(_, trial)| trial.is_none())
        .map(|(packing, _)| packing)
        .collect();
    let taken = AtomicUsize::new(0);
    let shared = Mutex::new((case, Ok(())));
    let work = || {
        while let Some(&packing) = left.get(taken.fetch_add(1, Ordering::Relaxed)) {
            let done = test(&factors, packing);
            let Ok(mut guard) = shared.lock() else { return };
            let (case, problem) = &mut *guard;
            let saved = done.and_then(|trial| {
                case.rounds[at].trials[packing] = Some(trial);
                save(case)
            });
            if saved.is_err() {
                if problem.is_ok() {
                    *problem = saved;
                }
                taken.store(left.len(), Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..workers.min(left.len()) {
            scope.spawn(work);
        }
        work();
    });
    // The scope has passed on the panic of a worker.
    shared.into_inner().map_or(Ok(()), |(_, problem)| problem)
}
