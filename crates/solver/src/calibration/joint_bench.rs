//! The tests of a calibration by several: a run of one of them with factors on the shared numbers,
//! and the first factors, without time steps.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use dem_calibration::{Aim, Free, JointStart, Trial, Unknown};
use dem_io::{Body, Result};
use dem_laboratory::TestType;
use dem_rig::evaluate::STRENGTH;

use super::bench::Bench;
use super::choice::{ModulusBy, unknowns};
use super::joint::TestScene;
use super::slopes::{is_bond_modulus, is_failure};
use super::start::Beginning;

/// The bodies of a test.
pub(crate) struct TestBodies {
    /// Name of the body that is packed several times.
    pub(crate) body: String,
    pub(crate) packings: Vec<Body>,
    /// All other bodies.
    pub(crate) others: BTreeMap<String, Body>,
}

/// The scenes of a calibration and their packings.
pub(crate) struct JointBench<'a> {
    pub(crate) tests: &'a [TestScene],
    /// `--set` values for all scenes.
    pub(crate) overrides: &'a [String],
    pub(crate) unknowns: &'a [Free],
    pub(crate) aims: &'a [Aim],
    /// One for each test.
    pub(crate) bodies: &'a [TestBodies],
    /// `--set` values for stroke and rate of each test: see [`super::start::pace`].
    pub(crate) paces: Vec<Vec<String>>,
    /// Stiffness of the measured curve of each test, N/m.
    pub(crate) stiffnesses: &'a [Option<f64>],
    pub(crate) by: ModulusBy,
    /// Whether a time step of the scene above the limit is taken.
    pub(crate) force_step: bool,
    /// Threads of one test.
    pub(crate) threads: usize,
    /// Set to stop.
    pub(crate) interrupted: &'a AtomicBool,
}

/// What statics say before the first round.
pub(crate) enum JointBeginning {
    /// The first factors, the slopes of the modulus of tests, and the travel at failure of each
    /// test, m.
    Start(JointStart, Vec<(usize, f64)>, Vec<Option<f64>>),
    /// A modulus cannot be met: problem and remedy.
    OutOfReach(String, String),
}

/// What statics say of a test: factors on modulus and strength, slope of the modulus.
#[derive(Default)]
struct OfTest {
    modulus: Option<(f64, f64)>,
    strength: Option<f64>,
}

impl JointBench<'_> {
    /// The test `at` of packing `packing` at `faster` times the rate of its scene; its results are
    /// those of all aims, of which only its own have values.
    pub(crate) fn test(
        &self,
        factors: &[f64],
        (at, packing): (usize, usize),
        faster: f64,
        tell: &(dyn Fn(f64) + Sync),
    ) -> Result<Trial> {
        let own: Vec<usize> = (0..self.aims.len())
            .filter(|aim| self.aims[*aim].test == at)
            .collect();
        let wanted = |aim: &usize| Unknown {
            numbers: Vec::new(),
            result: self.aims[*aim].result.clone(),
            unit: String::new(),
            target: self.aims[*aim].target,
            tolerance: 0.0,
            is_proportional: false,
        };
        let wanted: Vec<Unknown> = own.iter().map(wanted).collect();
        let trial = self.with_bench(at, factors, &wanted, &|bench| {
            bench.test(&vec![1.0; wanted.len()], packing, faster, tell)
        })?;
        let spread = |values: &[Option<f64>]| {
            let mut all = vec![None; self.aims.len()];
            for (aim, value) in own.iter().zip(values) {
                all[*aim] = *value;
            }
            all
        };
        Ok(Trial {
            results: spread(&trial.results),
            at_least: spread(&trial.at_least),
            ..trial
        })
    }

    /// Works with the bench of one test with these factors on the shared numbers.
    fn with_bench<R>(
        &self,
        at: usize,
        factors: &[f64],
        unknowns: &[Unknown],
        work: &dyn Fn(&Bench<'_>) -> Result<R>,
    ) -> Result<R> {
        let overrides = self.tests[at].overrides(self.overrides, self.unknowns, factors)?;
        let bodies = &self.bodies[at];
        work(&Bench {
            scene: self.tests[at].with(&overrides),
            unknowns,
            body: &bodies.body,
            packings: &bodies.packings,
            others: &bodies.others,
            force_step: self.force_step,
            pace: self.paces[at].clone(),
            threads: self.threads,
            interrupted: self.interrupted,
        })
    }

    /// First factors: the mean of what equilibria of each test say of modulus and strength. Tests
    /// whose walls keep a pressure, and dynamic ones, have no equilibria of theirs.
    pub(crate) fn start(&self) -> Result<JointBeginning> {
        let began = Instant::now();
        let mut factors = vec![1.0; self.unknowns.len()];
        let mut travels = vec![None; self.tests.len()];
        let mut found: Vec<OfTest> = Vec::new();
        found.resize_with(self.tests.len(), OfTest::default);
        let mut solutions = 0;
        let modulus = self.unknowns.iter().position(is_bond_modulus);
        // A test without a modulus takes that of the others.
        for has_modulus in [true, false] {
            for at in 0..self.tests.len() {
                let wanted = self.wanted(at, modulus.is_some())?;
                let is_now = wanted.iter().any(|one| one.result != STRENGTH) == has_modulus;
                if wanted.is_empty() || !is_now {
                    continue;
                }
                let start = match self.with_bench(at, &factors, &wanted, &|bench| bench.start())? {
                    Beginning::Unknown => continue,
                    Beginning::OutOfReach(problem, remedy) => {
                        let problem = format!("{}: {problem}", self.tests[at].scene.source);
                        return Ok(JointBeginning::OutOfReach(problem, remedy));
                    }
                    Beginning::Start(start) => start,
                };
                solutions += start.tests;
                travels[at] = start.travel_m;
                for (which, one) in wanted.iter().enumerate() {
                    match one.result == STRENGTH {
                        true => found[at].strength = Some(start.factors[which]),
                        false => {
                            found[at].modulus = Some((start.factors[which], start.slopes[which]));
                        }
                    }
                }
            }
            if let Some(which) = modulus.filter(|_| has_modulus) {
                let all = found.iter().filter_map(|one| Some(one.modulus?.0));
                factors[which] = geometric_mean(all).unwrap_or(1.0);
            }
        }
        for (unknown, factor) in self.unknowns.iter().zip(&mut factors) {
            *factor = self.strength_factor(unknown, &found).unwrap_or(*factor);
        }
        let slopes = found.iter().enumerate();
        let slopes = slopes.filter_map(|(at, one)| Some((at, one.modulus?.1)));
        let slopes = slopes.collect();
        let start = JointStart {
            factors,
            tests: solutions,
            wall_s: began.elapsed().as_secs_f64(),
        };
        Ok(JointBeginning::Start(start, slopes, travels))
    }

    /// Modulus and strength of bonds as unknowns of one test alone, as far as it has targets for
    /// them; none for a test without equilibria.
    fn wanted(&self, at: usize, frees_modulus: bool) -> Result<Vec<Unknown>> {
        let test = &self.tests[at];
        let kind = test.test()?.kind;
        if kind.is_dynamic() || kind.has_residual() {
            return Ok(Vec::new());
        }
        let text = test.with(self.overrides);
        // A test with other targets only.
        let Ok(found) = unknowns(&test.scene, &text, &[], self.by, self.stiffnesses[at]) else {
            return Ok(Vec::new());
        };
        let is_wanted = |one: &Unknown| frees_modulus || one.result == STRENGTH;
        Ok(found.into_iter().filter(is_wanted).collect())
    }

    /// The first factor on strengths: the mean over the tests that fail by them, or over all.
    fn strength_factor(&self, unknown: &Free, found: &[OfTest]) -> Option<f64> {
        let path = &unknown.numbers[0].path;
        if !is_failure(unknown) || path.ends_with(".friction_angle") {
            return None;
        }
        let tears = ["tensile_strength", "von_mises_strength"];
        let tears = tears.iter().any(|key| path.ends_with(key));
        let of = |fitting: bool| {
            let tests = self.tests.iter().zip(found);
            let fits = |test: &TestScene| {
                let kind = test.scene.test.as_ref().map(|test| test.kind);
                let presses = kind == Some(TestType::Compression);
                !fitting || unknown.numbers.len() > 1 || tears != presses
            };
            let tests = tests.filter(|(test, _)| fits(test));
            geometric_mean(tests.filter_map(|(_, one)| one.strength))
        };
        of(true).or_else(|| of(false))
    }
}

/// None: there are no values.
fn geometric_mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let logs: Vec<f64> = values.map(f64::ln).collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}
