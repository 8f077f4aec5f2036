//! Progress of a run besides its state: next outputs, and quantities monitored so far.

use std::collections::BTreeMap;

use dem_io::{Diagnostic, Result};
use dem_scene::Scene;
use serde::{Deserialize, Serialize};

use super::changes::last_change_s;
use super::last_tenth::LastTenth;
use super::monitors::Monitors;
use super::schedule::{OutputSchedule, first_after};
use super::sums::Sums;
use dem_engine::check::limit::Bound;
use dem_engine::stages::ledger::bookkeeping::over;
use dem_engine::state::State;
use dem_plan::time_step::{StepBasis, StepChoice};
use dem_results::Balance;
use dem_rig::record::Record;

/// What a run without `adaptive` would have now.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PlainStep {
    /// Its time step, s: an adaptive one is smaller only where it would be unstable.
    pub(super) step_s: f64,
    /// Speed of the impacts that this step allows for, m/s.
    impact_speed_m_s: f64,
}

impl PlainStep {
    fn of(basis: &StepBasis) -> Self {
        Self {
            step_s: basis.step_s,
            impact_speed_m_s: basis.impact_speed_m_s,
        }
    }

    /// Allows for impacts at a speed, m/s, with this step, s, if they are `faster` than allowed for.
    pub(super) fn allow_for(&mut self, speed_m_s: f64, largest_s: f64, faster: f64) {
        if speed_m_s > faster * self.impact_speed_m_s {
            self.impact_speed_m_s = speed_m_s;
            self.step_s = self.step_s.min(largest_s);
        }
    }
}

/// Progress of the output of a run, and of its monitors.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    rhythm: OutputSchedule,
    pub(super) next_row: u64,
    pub(super) next_frame: u64,
    pub(super) next_checkpoint: u64,
    /// Where each output stands, by its name.
    pub(super) positions: BTreeMap<String, Vec<u8>>,
    /// Check sums of the files of results.
    pub(super) sums: Sums,
    /// Largest errors of energy, momentum and angular momentum so far: J, N s, N m s.
    largest_errors: [f64; 3],
    /// Largest stable step at its last computation, s.
    pub(super) limit_s: f64,
    /// Result of that computation for bonds and the contacts at that time.
    pub(super) bound: Bound,
    /// Largest strain of a bond at that time.
    pub(super) bound_strain: f64,
    /// Upper bounds of the eigenvalues of the contacts at that time, 1/s2 and 1/s; 0 if unknown.
    pub(super) bound_rates: [f64; 2],
    /// The largest strain since.
    pub(super) strain: f64,
    /// Ratio of stiffness to mass of the stiffest contact that the step allows for, 1/s2.
    pub(super) contact_rate_1_s2: f64,
    /// Speed of the impacts that the step allows for, m/s.
    pub(super) impact_speed_m_s: f64,
    /// Step at which an adaptive time step is checked next, at the latest.
    pub(super) next_check: u64,
    /// Whether there were bonds at the last check.
    pub(super) had_bonds: bool,
    pub(super) plain: PlainStep,
    /// Smallest and largest time step so far, s.
    pub(super) steps_s: [f64; 2],
    /// Number of its changes.
    pub(super) step_changes: u64,
    /// Time since which the kinetic energy has been small compared with the elastic energy, s.
    pub(super) calm_since_s: Option<f64>,
    /// Whether it has ended at rest.
    pub(super) rested: bool,
    /// The measure that has ended it, and the value that it had to exceed.
    pub(super) exceeded: Option<(String, f64)>,
    /// Record of a laboratory test.
    pub(super) test: Record,
    /// Whether it has ended before its end time: the body broke, or the weight came to its end.
    pub(super) test_ended: bool,
    /// Quantities monitored besides the measures.
    pub(super) monitors: Monitors,
    /// What measures and servos did in the last tenth of the run.
    pub(super) last_tenth: LastTenth,
}

/// The value above which a measure of this name ends the run.
fn ends_run_above(scene: &Scene, name: &str) -> Option<f64> {
    scene.measures.get(name)?.end_run_above
}

impl Progress {
    /// For a run that has not begun.
    pub(super) fn new(rhythm: OutputSchedule, choice: &StepChoice) -> Self {
        Self {
            rhythm,
            limit_s: choice.foreseen_s,
            bound: choice.limit.bound(),
            contact_rate_1_s2: choice.contact_rate_1_s2,
            impact_speed_m_s: choice.impact_speed_m_s,
            had_bonds: true,
            plain: PlainStep::of(&choice.replaced),
            steps_s: [choice.step_s; 2],
            ..Self::default()
        }
    }

    /// Sets the requirements that the step meets from now on.
    pub(super) fn allow_for(&mut self, basis: &StepBasis) {
        self.limit_s = basis.foreseen_s;
        self.bound = basis.limit.bound();
        self.bound_rates = [0.0; 2];
        self.contact_rate_1_s2 = basis.contact_rate_1_s2;
        self.impact_speed_m_s = basis.impact_speed_m_s;
    }

    /// Adds requirements that the step meets from now on.
    pub(super) fn allow_as_well_for(&mut self, basis: &StepBasis) {
        if basis.limit.step_s < self.bound.step_s {
            self.bound = basis.limit.bound();
            self.bound_rates = [0.0; 2];
        }
        self.limit_s = self.limit_s.min(basis.foreseen_s);
        self.contact_rate_1_s2 = self.contact_rate_1_s2.max(basis.contact_rate_1_s2);
        self.impact_speed_m_s = self.impact_speed_m_s.max(basis.impact_speed_m_s);
    }

    /// Records a new time step, s.
    pub(super) fn note_step(&mut self, step_s: f64) {
        let [smallest, largest] = self.steps_s;
        self.steps_s = [smallest.min(step_s), largest.max(step_s)];
        self.step_changes += 1;
    }

    /// Reason why a run in the present state has nothing left to do, and how to continue it. None:
    /// it is not over.
    pub(super) fn is_over(
        &self,
        state: &State,
        rhythm: OutputSchedule,
        scene: &Scene,
    ) -> Option<(String, &'static str)> {
        let before_s = state.time_s - 0.5 * state.previous_time_step_s;
        if before_s >= scene.run.end_time_s {
            return Some((
                format!(
                    "this run has reached {before_s:.6e} s, and run.end_time is {:.6e} s",
                    scene.run.end_time_s
                ),
                "set a later end: --set run.end_time=...",
            ));
        }
        if self.rested && rhythm.rest == self.rhythm.rest {
            return Some((
                format!("this run has come to rest at {before_s:.6e} s"),
                "set a smaller run.rest_energy_ratio",
            ));
        }
        if let Some((name, value)) = &self.exceeded
            && ends_run_above(scene, name) == Some(*value)
        {
            return Some((
                format!("measures.{name} has ended this run at {before_s:.6e} s"),
                "set a larger end_run_above of this measure",
            ));
        }
        self.test_ended.then(|| {
            let what = if self.test.fell {
                "the body of this test has broken"
            } else {
                "this test has ended"
            };
            (
                format!("{what} at {before_s:.6e} s"),
                "run its fragments in another scene",
            )
        })
    }

    /// Resumes from a checkpoint of the present state, perhaps with other output intervals. Refuses
    /// a run that is over.
    pub(super) fn go_on(
        &mut self,
        state: &State,
        rhythm: OutputSchedule,
        scene: &Scene,
    ) -> Result<()> {
        if let Some((problem, further)) = self.is_over(state, rhythm, scene) {
            return Err(Diagnostic::input(
                "--resume",
                problem,
                format!("nothing is left to be done; to take it further, {further}"),
            ));
        }
        let before_s = state.time_s - 0.5 * state.previous_time_step_s;
        if rhythm.rest != self.rhythm.rest {
            self.calm_since_s = None;
        }
        self.rested = false;
        self.exceeded = None;
        if rhythm != self.rhythm {
            self.next_row = first_after(before_s, rhythm.row_s);
            self.next_frame = rhythm.frame_s.map_or(0, |s| first_after(before_s, s));
            self.next_checkpoint = rhythm.checkpoint_s.map_or(0, |s| first_after(before_s, s));
            self.rhythm = rhythm;
        }
        Ok(())
    }

    pub(super) fn note(&mut self, state: &State, balance: &Balance, rest: Option<f64>) {
        let [momentum, angular_momentum] = balance.momentum_scales;
        let errors = [
            balance.energy_error_j,
            momentum * balance.momentum_error,
            angular_momentum * balance.angular_momentum_error,
        ];
        self.monitors.note_kinetic(balance.kinetic_j);
        for (largest, error) in self.largest_errors.iter_mut().zip(errors) {
            *largest = largest.max(error.abs());
        }
        if let Some(fraction) = rest {
            let settled = state.time_s >= last_change_s(state);
            let calm = settled && balance.kinetic_j <= fraction * balance.elastic_j();
            self.calm_since_s = calm.then(|| self.calm_since_s.unwrap_or(state.time_s));
        }
    }

    /// Largest errors so far of energy, momentum and angular momentum, divided by the largest
    /// energy and momenta until now.
    pub(super) fn largest_errors(&self, balance: &Balance) -> [f64; 3] {
        let [energy, momentum, angular_momentum] = self.largest_errors;
        let [of_momentum, of_angular_momentum] = balance.momentum_scales;
        [
            over(energy, balance.energy_scale_j),
            over(momentum, of_momentum),
            over(angular_momentum, of_angular_momentum),
        ]
    }

    /// Whether it has been calm during the last fifth of the run.
    pub(super) fn has_rested(&self, state: &State) -> bool {
        self.calm_since_s.is_some_and(|since_s| {
            state.time_s > 0.0 && state.time_s - since_s >= 0.2 * state.time_s
        })
    }
}
