//! What a calibration has done so far: its tests, in rounds, and how it ended.

use dem_laboratory::Statistic;
use serde::{Deserialize, Serialize};

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

impl Round {
    /// With these factors, before its tests.
    pub(crate) fn new(factors: Vec<f64>, packings: usize) -> Self {
        Self {
            factors,
            trials: vec![None; packings],
        }
    }

    /// Mean and scatter of a result. None: no packing has it.
    pub fn statistic(&self, unknown: usize) -> Option<Statistic> {
        let trials = self.trials.iter().flatten();
        let values: Vec<f64> = trials.filter_map(|trial| trial.results[unknown]).collect();
        // A mean over some of the packings only is not that of all.
        (values.len() == self.trials.len()).then(|| Statistic::of(&values))
    }

    /// Whether every packing has its test.
    pub fn is_whole(&self) -> bool {
        self.trials.iter().all(Option::is_some)
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

    /// A value that the mean of a result is at least, if there are any, and the number of packings
    /// that do not have the result.
    pub(crate) fn least_mean(&self, unknown: usize) -> Option<(f64, usize)> {
        let trials = || self.trials.iter().flatten();
        let bounds =
            trials().filter_map(|trial| trial.results[unknown].or(trial.at_least[unknown]));
        let bounds: Vec<f64> = bounds.collect();
        let missing = trials().filter(|trial| trial.results[unknown].is_none());
        let sum: f64 = bounds.iter().sum();
        (!bounds.is_empty()).then(|| (sum / bounds.len() as f64, missing.count()))
    }
}

/// The first factors, from tests without time steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Start {
    /// Factor on the numbers of each unknown.
    pub factors: Vec<f64>,
    /// ln(result) over ln(factor) of each unknown there.
    pub slopes: Vec<f64>,
    /// Travel at which a body with the wanted strength fails, m: the largest of the packings. None:
    /// there is no strength to meet.
    pub travel_m: Option<f64>,
    /// Number of tests without steps.
    pub tests: usize,
    /// Run time, s.
    pub wall_s: f64,
}

/// How a calibration ended.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum End {
    /// All mean results are within their tolerances.
    Met,
    /// They are not, but each target is within the 95 % confidence interval of its mean.
    WithinScatter,
    /// The problem, and a remedy.
    NotMet(String, String),
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
    /// Mean diameter of the spheres of the first packing, m.
    pub mean_diameter_m: f64,
    /// The first factors. None: 1.
    pub start: Option<Start>,
    /// The rounds.
    pub rounds: Vec<Round>,
    /// The round that is the result, and how it ended. None: it has not ended.
    pub end: Option<(usize, End)>,
    /// The tests of all packings with the numbers of the result at twice the rate. None: not asked
    /// for, or not begun.
    pub at_twice_the_rate: Option<Round>,
    /// Why there are no such tests although the scene asks for them.
    pub rate_problem: Option<String>,
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

    /// True if the tests at twice the rate have been done, or have failed.
    pub fn has_rate_check(&self) -> bool {
        let done = self.at_twice_the_rate.as_ref();
        done.is_some_and(Round::is_whole) || self.rate_problem.is_some()
    }

    /// By what half the rate changes the result of an unknown, relative to it, over the packings.
    pub fn rate_change(&self, unknown: usize) -> Option<Statistic> {
        let (slow, fast) = (self.result()?, self.at_twice_the_rate.as_ref()?);
        let pairs = slow.trials.iter().zip(&fast.trials);
        let change = |(slow, fast): (&Option<Trial>, &Option<Trial>)| {
            let [slow, fast] = [slow, fast].map(|trial| trial.as_ref()?.results[unknown]);
            Some(slow? / fast? - 1.0)
        };
        let changes: Vec<f64> = pairs.filter_map(change).collect();
        (!changes.is_empty()).then(|| Statistic::of(&changes))
    }

    /// Run time of all tests, s, and their number.
    pub fn cost(&self) -> (f64, usize) {
        let trials = || {
            self.rounds
                .iter()
                .flat_map(|round| round.trials.iter().flatten())
        };
        // The sum of no numbers is -0.
        let wall_s = trials().fold(0.0, |sum, trial| sum + trial.wall_s);
        (wall_s, trials().count())
    }
}
