//! A calibration by several tests: what it is to do, and what it has done so far.

use dem_laboratory::{FailureLine, Statistic, TestType};
use serde::{Deserialize, Serialize};

use crate::case::{End, Round, Trial};
use crate::unknown::Number;

/// Numbers of the material that are multiplied by one factor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Free {
    /// The numbers; at least one.
    pub numbers: Vec<Number>,
    /// Largest factor that makes sense: a friction angle stays below 90 degrees.
    pub largest: f64,
}

/// A result of one of the tests, and its wanted value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Aim {
    /// Index of the test.
    pub test: usize,
    /// Name of the result.
    pub result: String,
    /// SI unit of the result; empty for plain numbers.
    pub unit: String,
    /// Wanted result; above 0.
    pub target: f64,
    /// Largest relative deviation of the mean result from the target.
    pub tolerance: f64,
    /// d ln(result)/d ln(factor) of each unknown, by statics or a closed form. None: a round finds
    /// it.
    pub slopes: Vec<Option<f64>>,
}

/// A test of several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointTest {
    /// File of its scene.
    pub scene: String,
    /// Type of test.
    pub kind: TestType,
    /// Confining pressure of a triaxial test, normal stress of a shear test, Pa. None: other tests.
    pub pressure_pa: Option<f64>,
    /// Names of the packings of its body.
    pub packings: Vec<String>,
    /// How they were made: the arguments of `dem-pack`. Empty: they were given.
    pub packed_with: String,
    /// Particles of the first packing.
    pub particles: usize,
    /// Bonds of the first packing.
    pub bonds: usize,
    /// Smallest extent of the body over the mean diameter of its spheres.
    pub spheres_across: f64,
    /// Mean diameter of the spheres of the first packing, m.
    pub mean_diameter_m: f64,
    /// Travel at which a body with the wanted strength fails, by statics, m. None: not known.
    pub travel_m: Option<f64>,
    /// The measured curve: displacement, m, and load, N. Empty: there is none.
    pub wanted_curve: Vec<[f64; 2]>,
}

/// The first factors, by statics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointStart {
    /// Factor on the numbers of each unknown.
    pub factors: Vec<f64>,
    /// Number of tests without steps.
    pub tests: usize,
    /// Run time, s.
    pub wall_s: f64,
}

/// A calibration by several tests: what it is to do, and what it has done so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Joint {
    /// Version of this format.
    pub version: u32,
    /// Program and its version.
    pub program: String,
    /// Day on which it began, as in 2026-01-31.
    pub date: String,
    /// Hash of the scenes, their files and the packings.
    pub identity: u64,
    /// The tests, at least two.
    pub tests: Vec<JointTest>,
    /// What is varied.
    pub unknowns: Vec<Free>,
    /// What it is to give; at least as many as unknowns.
    pub aims: Vec<Aim>,
    /// The first factors. None: statics are not done yet.
    pub start: Option<JointStart>,
    /// The rounds. Trials: of all packings of the first test, then of the second and so on, each
    /// with an entry for each aim, of which only those of its own test have values.
    pub rounds: Vec<Round>,
    /// The round that is the result, and how it ended. None: it has not ended.
    pub end: Option<(usize, End)>,
    /// The tests with `rate_check` with the numbers of the result at twice the rate; others have no
    /// trials. None: not asked for, or not begun.
    pub at_twice_the_rate: Option<Round>,
    /// Why there are no such tests although scenes ask for them.
    pub rate_problem: Option<String>,
}

impl Joint {
    /// Number of tests of a round.
    pub fn jobs(&self) -> usize {
        self.tests.iter().map(|test| test.packings.len()).sum()
    }

    /// Test and packing of a trial of a round.
    pub fn job(&self, at: usize) -> (usize, usize) {
        let mut left = at;
        for (test, one) in self.tests.iter().enumerate() {
            if left < one.packings.len() {
                return (test, left);
            }
            left -= one.packings.len();
        }
        (self.tests.len(), left)
    }

    /// Indices of the trials of a test in a round.
    pub(crate) fn trials_of(&self, test: usize) -> std::ops::Range<usize> {
        let count = |tests: &[JointTest]| tests.iter().map(|test| test.packings.len()).sum();
        let from: usize = count(&self.tests[..test]);
        from..from + self.tests[test].packings.len()
    }

    /// The round that is the result, or the last one.
    pub fn result(&self) -> Option<&Round> {
        match &self.end {
            Some((at, _)) => self.rounds.get(*at),
            None => self.rounds.last(),
        }
    }

    /// Mean and scatter of an aim in a round. None: a packing does not have it.
    pub fn statistic(&self, round: &Round, aim: usize) -> Option<Statistic> {
        let trials = &round.trials[self.trials_of(self.aims[aim].test)];
        let value = |trial: &Option<Trial>| trial.as_ref()?.results[aim];
        let values: Option<Vec<f64>> = trials.iter().map(value).collect();
        values.map(|values| Statistic::of(&values))
    }

    /// ln(target/mean) of an aim in a round. None: a packing does not have it.
    pub(crate) fn wanted(&self, round: &Round, aim: usize) -> Option<f64> {
        let mean = self.statistic(round, aim)?.mean;
        Some((self.aims[aim].target / mean).ln())
    }

    /// True if its targets are met, at least within the scatter of the packings.
    pub fn is_met(&self) -> bool {
        matches!(&self.end, Some((_, End::Met | End::WithinScatter)))
    }

    /// Problem and remedy of targets that are not met.
    pub fn problem(&self) -> Option<(String, String)> {
        match &self.end {
            Some((_, End::NotMet(problem, remedy))) => Some((problem.clone(), remedy.clone())),
            _ => None,
        }
    }

    /// Run time of all tests with steps, s, and their number.
    pub fn cost(&self) -> (f64, usize) {
        let rounds = || self.rounds.iter().chain(&self.at_twice_the_rate);
        let trials = || rounds().flat_map(|round| round.trials.iter().flatten());
        let wall_s = trials().fold(0.0, |sum, trial| sum + trial.wall_s);
        (wall_s, trials().count())
    }

    /// By what half the rate changes an aim, relative to it, over the packings. None: not tested.
    pub fn rate_change(&self, aim: usize) -> Option<Statistic> {
        let (slow, fast) = (self.result()?, self.at_twice_the_rate.as_ref()?);
        let of = |at: usize| {
            let [slow, fast] = [slow, fast].map(|round| round.trials[at].as_ref()?.results[aim]);
            Some(slow? / fast? - 1.0)
        };
        let changes: Vec<f64> = self.trials_of(self.aims[aim].test).filter_map(of).collect();
        (!changes.is_empty()).then(|| Statistic::of(&changes))
    }

    /// The failure lines of a type of test under pressure: through the targets, and through the
    /// means of a round. None: strengths at fewer than two pressures, or no line of Mohr and
    /// Coulomb.
    pub(crate) fn failure_lines(&self, round: &Round, kind: TestType) -> Option<[FailureLine; 2]> {
        let mut points = [Vec::new(), Vec::new()];
        for (at, aim) in self.aims.iter().enumerate() {
            let test = &self.tests[aim.test];
            if test.kind != kind || aim.result != "strength" {
                continue;
            }
            let pressure_pa = test.pressure_pa?;
            points[0].push([pressure_pa, aim.target]);
            points[1].push([pressure_pa, self.statistic(round, at)?.mean]);
        }
        let [targets, means] = points.map(|points| FailureLine::of_strengths(kind, &points));
        Some([targets?, means?])
    }

    /// The record without its curves.
    pub fn without_curves(&self) -> Self {
        let mut joint = self.clone();
        for test in &mut joint.tests {
            test.wanted_curve.clear();
        }
        let rounds = joint.rounds.iter_mut().chain(&mut joint.at_twice_the_rate);
        for trial in rounds.flat_map(|round| round.trials.iter_mut().flatten()) {
            trial.curve.clear();
        }
        joint
    }
}
