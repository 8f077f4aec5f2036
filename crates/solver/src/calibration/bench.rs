//! One test of a packing with a factor on the numbers of each unknown.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use dem_calibration::{Trial, Unknown};
use dem_io::{Body, Result};
use dem_scene::{Scene, Test, scene_from_text, set_text};

use super::choice::SceneText;
use crate::cli::pool::pool_of;
use dem_laboratory::Specimen;
use dem_plan::Plan;
use dem_results::Summary;
use dem_rig::arrange::{arrange, tested_body};
use dem_rig::evaluate::{FAILURE_FORCE, LARGEST_FORCE, STRENGTH};
use dem_rig::plan_with_test;
use dem_rig::setup::Setup;
use dem_rig::watch::TestSettings;
use dem_runner::{RunSettings, SoFar, run};

/// The scene of a calibration and its packings.
pub(crate) struct Bench<'a> {
    pub(crate) scene: SceneText<'a>,
    /// What is varied.
    pub(crate) unknowns: &'a [Unknown],
    /// Name of the body that is packed several times.
    pub(crate) body: &'a str,
    pub(crate) packings: &'a [Body],
    /// All other bodies.
    pub(crate) others: &'a BTreeMap<String, Body>,
    /// Whether a time step of the scene above the limit is taken.
    pub(crate) force_step: bool,
    /// `--set` values for stroke and rate of the tests: see [`super::start::pace`].
    pub(crate) pace: Vec<String>,
    /// Threads of one test.
    pub(crate) threads: usize,
    /// Set to stop.
    pub(crate) interrupted: &'a AtomicBool,
}

impl Bench<'_> {
    /// The test of packing `at` at `faster` times the rate of the scene; `tell` is called with its
    /// progress, in 0..1.
    pub(crate) fn test(
        &self,
        factors: &[f64],
        at: usize,
        faster: f64,
        tell: &(dyn Fn(f64) + Sync),
    ) -> Result<Trial> {
        pool_of(self.threads)?.install(|| self.test_here(factors, at, faster, tell))
    }

    fn test_here(
        &self,
        factors: &[f64],
        at: usize,
        faster: f64,
        tell: &(dyn Fn(f64) + Sync),
    ) -> Result<Trial> {
        let began = Instant::now();
        let planned = self.planned(factors, at, faster)?;
        let (scene, plan, setup, lowest_hz) = planned;
        let specimen = setup.as_ref().map(|setup| setup.specimen);
        let loaded = specimen.zip(scene.test.as_ref());
        let wanted_n = loaded.and_then(|(specimen, test)| wanted_n(test, &specimen));
        let settings = RunSettings {
            folder: None,
            resume: None,
            threads: self.threads,
            interrupted: self.interrupted,
            test: lowest_hz.map(|lowest_frequency_hz| TestSettings {
                lowest_frequency_hz,
                at_twice_the_rate: None,
                wanted_n,
            }),
            setup,
        };
        let tell = |so_far: &SoFar| tell(so_far.fraction);
        let summary = run(plan, &scene, settings, &tell)?;
        let mut trial = self.trial(&scene, &summary);
        if let (Some(specimen), Some(test)) = (specimen, &summary.test) {
            let largest_n = test.figure(LARGEST_FORCE);
            let stress_pa = largest_n.map(|force| specimen.stress_pa(force));
            for (unknown, bound) in self.unknowns.iter().zip(&mut trial.at_least) {
                if unknown.result == STRENGTH {
                    *bound = stress_pa;
                }
            }
        }
        trial.wall_s = began.elapsed().as_secs_f64();
        Ok(trial)
    }

    /// The scene with these factors and packing `at`, its plan, and the lowest frequency of a test.
    pub(super) fn planned(
        &self,
        factors: &[f64],
        at: usize,
        faster: f64,
    ) -> Result<(Scene, Plan, Option<Setup>, Option<f64>)> {
        let mut overrides = overrides(&self.scene, self.unknowns, factors);
        overrides.extend(self.pace.iter().cloned());
        let SceneText { text, source, .. } = self.scene;
        let mut scene = scene_from_text(text, source, &overrides)?;
        // The numbers that are found are those of this body.
        for kind in scene.bonds.values_mut() {
            kind.size_correction = false;
        }
        let mut bodies = self.others.clone();
        bodies.insert(self.body.to_owned(), self.packings[at].clone());
        let tested = tested_body(&scene, &bodies, self.threads)?;
        let scene = match &tested {
            Some(tested) => arrange(&scene, tested, faster)?,
            None => scene,
        };
        let (plan, setup) = plan_with_test(&scene, bodies, self.threads, self.force_step)?;
        Ok((
            scene,
            plan,
            setup,
            tested.map(|body| body.lowest_frequency_hz),
        ))
    }

    /// What a run says.
    fn trial(&self, scene: &Scene, summary: &Summary) -> Trial {
        let measures = || summary.measures.iter();
        let test = summary.test.as_ref();
        let result = |unknown: &Unknown| {
            let of_test = test.and_then(|test| test.figure(&unknown.result));
            let measure = measures().find(|measure| measure.name == unknown.result);
            let of_run = || summary.run_result(&unknown.result);
            let value = of_test
                .or(measure.map(|measure| measure.value))
                .or_else(of_run);
            value.filter(|value| value.is_finite() && *value > 0.0)
        };
        Trial {
            results: self.unknowns.iter().map(result).collect(),
            at_least: vec![None; self.unknowns.len()],
            curve: test.map_or_else(Vec::new, |test| test.curve.clone()),
            doubts: doubts(scene, summary),
            broken_at_peak: test.map_or(0, |test| test.broken_at_peak),
            wall_s: 0.0,
        }
    }
}

/// Load under which a specimen has the strength that its test asks for, N.
pub(super) fn wanted_n(test: &Test, specimen: &Specimen) -> Option<f64> {
    test.strength_pa
        .map(|strength_pa| strength_pa / specimen.stress_pa(1.0))
}

/// `--set` values of a scene with these factors on its numbers.
pub(crate) fn overrides(
    scene: &SceneText<'_>,
    unknowns: &[Unknown],
    factors: &[f64],
) -> Vec<String> {
    let mut overrides = scene.overrides.to_vec();
    for (unknown, factor) in unknowns.iter().zip(factors) {
        for number in &unknown.numbers {
            overrides.push(set_text(&number.path, number.times(*factor), &number.unit));
        }
    }
    overrides
}

/// Reasons to doubt a run, with the remedy for a crack outside the region of its test.
fn doubts(scene: &Scene, summary: &Summary) -> Vec<String> {
    let mut doubts = summary.verdict.warnings.clone();
    let Some(test) = &summary.test else {
        return doubts;
    };
    let is_outside = test.crack.as_ref().is_some_and(|crack| !crack.is_within);
    let presses = scene.test.as_ref().is_some_and(|test| {
        let is_wall = |name: &String| scene.walls.contains_key(name);
        test.crosshead.iter().any(is_wall)
    });
    if is_outside && presses && test.figure(FAILURE_FORCE).is_some() {
        doubts.push(
            "if bonds break at pins or plates first, use tensile_strength in place of von_mises_strength, thicker pins, or smaller spheres"
                .to_owned(),
        );
    }
    doubts
}
