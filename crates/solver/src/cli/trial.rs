//! The run time of a scene, predicted from its first steps and its first picture.

use std::time::Instant;

use dem_io::Result;
use dem_io::units::significant;
use dem_pictures::film::chosen_for_film;
use dem_pictures::png_file::{Compression, to_png};
use dem_scene::Scene;

use super::flow_trial::FlowTrial;
use dem_engine::clock::StageClock;
use dem_engine::stages::ledger::bookkeeping::CHECKS;
use dem_engine::step::{number_of, step};
use dem_plan::{Plan, PlannedStage};
use dem_runner::pictures::View;

/// The run time is predicted from this many samples of the first steps of a copy.
const SAMPLES: usize = 8;
/// Number of steps of a sample, and their time limit, s.
const SAMPLE: (u64, f64) = (250, 0.07);

/// Cost of the first steps, tried on a copy.
pub(super) struct Trial {
    /// Of a step; in several samples, of the fastest one, which other programs have disturbed
    /// least.
    per_step_s: f64,
    clock: StageClock,
    /// Shortest and longest run time to expect, with pictures, s.
    pub(super) range_s: [f64; 2],
    /// When it is the longest.
    pub(super) longest_if: &'static str,
    /// Number of pictures, and the time for all of them and their film, s.
    pictures: usize,
    pub(super) pictures_s: f64,
    /// What it has shown, a sentence each.
    pub(super) notes: Vec<String>,
}

impl Trial {
    /// `steps`: number of steps of the run, of which the first few tell the time of all unless
    /// bodies come, go or are replaced.
    pub(super) fn of(scene: &Scene, plan: &Plan, steps: f64) -> Result<Self> {
        let mut trial = if plan.state.model.rules.are_none() {
            Self::of_steps(plan, steps)
        } else {
            let flow = FlowTrial::of(plan, scene.run.end_time_s);
            Self {
                notes: flow.notes().collect(),
                per_step_s: flow.per_step_s,
                range_s: flow.range_s,
                longest_if: "if bodies go on gathering as in the trial",
                clock: flow.clock,
                pictures: 0,
                pictures_s: 0.0,
            }
        };
        (trial.pictures, trial.pictures_s) = time_of_pictures(scene, plan)?;
        trial.range_s = trial.range_s.map(|s| s + trial.pictures_s);
        Ok(trial)
    }

    /// By the fastest and by the slowest sample.
    fn of_steps(plan: &Plan, steps: f64) -> Self {
        let mut copy = plan.state.clone();
        let mut sample_s = || {
            let clock = Instant::now();
            let first = copy.steps;
            let mut done = 0;
            while done < SAMPLE.0 && (done < 1 || clock.elapsed().as_secs_f64() < SAMPLE.1) {
                step(&mut copy);
                done = copy.steps - first;
            }
            clock.elapsed().as_secs_f64() / done as f64
        };
        let samples_s: Vec<f64> = (0..SAMPLES).map(|_| sample_s()).collect();
        let per_step_s = samples_s.iter().copied().fold(f64::INFINITY, f64::min);
        let most_per_step_s = samples_s.iter().copied().fold(0.0, f64::max);
        Self {
            per_step_s,
            clock: copy.scratch.clock,
            range_s: [per_step_s, most_per_step_s].map(|s| steps * s),
            longest_if: "while it is as busy as now",
            pictures: 0,
            pictures_s: 0.0,
            notes: Vec::new(),
        }
    }

    /// What pictures take, after the run time.
    pub(super) fn pictures_text(&self) -> String {
        match self.pictures {
            0 => String::new(),
            pictures => format!(
                ", of it {} s for {pictures} pictures",
                significant(self.pictures_s, 2)
            ),
        }
    }

    /// Cost of a stage that has its own time and is active in steps, ns per step.
    pub(super) fn cost_ns(&self, stage: &PlannedStage) -> Option<f64> {
        let has_own = stage.stage.within.is_none() && *stage.stage != CHECKS;
        has_own.then(|| 1e9 * self.per_step_s * self.clock.fraction(number_of(stage.stage)))
    }
}

/// Number of pictures of a run, and the time for them and their film, s: that of the first one for
/// each.
fn time_of_pictures(scene: &Scene, plan: &Plan) -> Result<(usize, f64)> {
    let Some(every_s) = scene.output.as_ref().and_then(|output| output.pictures_s) else {
        return Ok((0, 0.0));
    };
    let count = (scene.run.end_time_s / every_s).floor() + 1.0;
    let of_film = chosen_for_film(count.min(1e6) as usize).len() as f64;
    let clock = Instant::now();
    let from = scene.output.as_ref().and_then(|output| output.view_from);
    let image = View::of(&plan.state, from, None).picture(&plan.state, &plan.bodies, every_s);
    let drawn_s = clock.elapsed().as_secs_f64();
    to_png(&image, Compression::Fast)?;
    let encoded_s = clock.elapsed().as_secs_f64() - drawn_s;
    Ok((
        count as usize,
        count * (drawn_s + encoded_s) + of_film * encoded_s,
    ))
}
