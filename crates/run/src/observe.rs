//! Observation and output of a run: between the two halves of a step, where everything can be
//! measured, and after the second.

use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_results::checkpoint::write_checkpoint;
use dem_results::folder::names;

use super::begin::Run;
use super::limits::{CHECK_EVERY_STEPS, tunnelling};
use super::outputs::{Changes, Moment, save_outputs};
use super::schedule::{due, next};
use super::settings::SoFar;
use super::snapshot::Snapshot;
use dem_engine::stages::clumps::motion::place_all;
use dem_engine::stages::contacts::touching::contacts_now;
use dem_engine::stages::ledger::bookkeeping::{CHECKS, balance};
use dem_engine::stages::stage::Stage;
use dem_engine::stages::watching::OUTPUT;
use dem_engine::state::State;
use dem_engine::state::bodies::renumber;
use dem_engine::state::events::PopulationEvent;
use dem_engine::step::number_of;
use dem_plan::measure::{Probe, read_probes, renumber as renumber_probes};
use dem_results::Balance;
use dem_rig::watch::Watch;

/// Wall time between two checkpoints unless the scene sets an interval.
const CHECKPOINT_EVERY: Duration = Duration::from_mins(1);

/// Why a run ended that went on to its end time.
pub(super) const AT_END_TIME: &str = "end time";
/// Why a run ended that was interrupted.
pub const INTERRUPTION: &str = "interruption";

/// Interval between checks of bending and twisting of bonds, in steps: each check costs about five
/// times as much as the bonds of a step.
const EDGES_EVERY: u64 = 1024;

/// Contacts are looked at in each step if they are no more than this, otherwise in every eighth:
/// once something has touched every body, and before.
const FEW_CONTACTS: usize = 64;
const FEW_BEFORE_ALL_TOUCHED: usize = 1024;

/// The reason why the loop over steps ends.
pub(super) struct Ended {
    pub(super) by: &'static str,
    pub(super) balance: Balance,
    pub(super) problem: Option<Diagnostic>,
}

impl Ended {
    fn new(by: &'static str, balance: Balance, problem: Option<Diagnostic>) -> Self {
        Self {
            by,
            balance,
            problem,
        }
    }
}

/// Output that is due at a step.
#[derive(Debug, Clone, Copy)]
struct Due {
    /// The run ends with this step.
    end: bool,
    row: bool,
    frame: bool,
    checkpoint: bool,
    /// An output is due at an interval of its own.
    output: bool,
    watchdog: bool,
}

impl Due {
    fn any(self) -> bool {
        self.row || self.frame || self.checkpoint || self.output || self.watchdog
    }

    /// A checkpoint of a run that has gone unstable would be worthless.
    fn needs_balance(self) -> bool {
        self.row || self.checkpoint || self.watchdog
    }
}

impl Run<'_> {
    /// Evaluates the step where everything can be measured, and writes the output that is due.
    /// Returns how the run has ended, if it has.
    pub(super) fn observe(&mut self, tell: &dyn Fn(&SoFar)) -> Result<Option<Ended>> {
        if let Some(problem) = tunnelling(&self.state, self.scene, &self.bodies) {
            return Ok(Some(self.ended_early("instability", problem)));
        }
        self.note_step()?;
        let test = self.watch.as_ref();
        let over = test.is_some_and(|watch| watch.note(&mut self.progress.test, &self.state));
        if test.is_some_and(Watch::answers_at_its_peak) {
            let largest_n = self.progress.test.largest_n;
            self.progress.monitors.note_peak(largest_n);
        }
        let due = self.due(over);
        let since = due.any().then(Instant::now);
        if due.any() {
            place_all(&self.state.clumps, &mut self.state.particles);
        }
        let (mut rests, mut exceeded) = (false, false);
        let (mut balanced, mut values) = (None, None);
        if due.needs_balance() {
            let balance = balance(&mut self.state);
            if let Err(problem) = self.watchdog.look(&self.state, &balance, &self.bodies) {
                let problem = Some(self.with_checkpoint(problem));
                return Ok(Some(Ended::new("instability", balance, problem)));
            }
            self.progress
                .note(&self.state, &balance, self.schedule.rest);
            rests = self.progress.has_rested(&self.state);
            if due.row || rests {
                values = Some(self.measure(&balance, tell));
                exceeded = self.progress.exceeded.is_some() && !due.end && !rests;
            }
            balanced = Some(balance);
        }
        let ends_early = rests || exceeded;
        let is_frame = due.frame || ends_early;
        if is_frame {
            let every_s = self.schedule.frame_s;
            self.progress.next_frame = every_s.map_or(0, |s| next(&self.state, s));
        }
        if due.any() {
            let now = Moment {
                state: &self.state,
                bodies: &self.bodies,
                row: balanced.as_ref().zip(values.as_deref()),
                is_frame,
                is_last: due.end || ends_early,
            };
            for (_, output) in &mut self.outputs {
                output.write(&now)?;
            }
        }
        self.plan_checkpoint(due);
        if let (true, Some(balance)) = (due.end || ends_early, balanced) {
            self.progress.rested = rests && !due.end;
            self.progress.test_ended = over;
            let by = match (due.end, &self.watch) {
                (true, Some(watch)) => watch.ended_by(over),
                (true, None) => AT_END_TIME,
                (false, _) if rests => "rest",
                (false, _) => "measure",
            };
            return Ok(Some(Ended::new(by, balance, None)));
        }
        book(&mut self.state, &OUTPUT, since);
        Ok(None)
    }

    /// Handles the changes of bodies in the second half of the step, and the limit of the time
    /// step; writes a checkpoint if one is due. Returns how the run has ended, if it has.
    pub(super) fn follow(&mut self) -> Result<Option<Ended>> {
        let changed = self.follow_population();
        let since = self
            .state
            .steps
            .is_multiple_of(CHECK_EVERY_STEPS)
            .then(Instant::now);
        let replaced = changed == Some(true);
        let (bodies, progress) = (&self.bodies, &mut self.progress);
        let followed = (self.limits).follow(&mut self.state, replaced, progress, bodies);
        book(&mut self.state, &CHECKS, since);
        self.note_changes(changed.is_some(), false)?;
        if let Err(problem) = followed {
            return Ok(Some(self.ended_early("instability", problem)));
        }
        let interrupted = self.settings.interrupted.load(Ordering::Relaxed);
        if interrupted || self.is_checkpoint_due {
            self.saved = Instant::now();
            self.save()?;
        }
        if interrupted {
            let problem = Some(self.interruption());
            let balance = balance(&mut self.state);
            return Ok(Some(Ended::new(INTERRUPTION, balance, problem)));
        }
        Ok(None)
    }

    /// Records the events of the first half of the step.
    fn note_step(&mut self) -> Result<()> {
        let (state, bodies, monitors) = (&self.state, &self.bodies, &mut self.progress.monitors);
        monitors.note_breaks(state, bodies);
        monitors.note_stand(state);
        if state.steps.is_multiple_of(EDGES_EVERY) {
            monitors.look_at_edges(state, bodies);
        }
        // A bounce may last for a few steps only. Few contacts cost nothing; many last longer.
        let few = 1..=if monitors.misses_one(self.scene) {
            FEW_BEFORE_ALL_TOUCHED
        } else {
            FEW_CONTACTS
        };
        let is_turn = state.steps.is_multiple_of(CHECK_EVERY_STEPS);
        if is_turn || few.contains(&contacts_now(state)) {
            monitors.look_at_contacts(state, self.scene, bodies);
            monitors.taken.look(state);
            let time_s = state.time_s;
            let hits = &mut monitors.rigid_hits;
            hits.take(&mut self.state.clumps, time_s, false);
            let State {
                rigid_parts, bonds, ..
            } = &mut self.state;
            hits.take_of_parts(rigid_parts, bonds, bodies, (time_s, false));
        }
        let (state, bodies) = (&self.state, &self.bodies);
        for (_, output) in &mut self.outputs {
            output.note_breakage(state, bodies)?;
        }
        Ok(())
    }

    /// Records the changes in the second half of the step. `has_other_bodies`: some have been
    /// added, removed or replaced; `is_after_end`: only a continued run shows them.
    pub(super) fn note_changes(
        &mut self,
        has_other_bodies: bool,
        is_after_end: bool,
    ) -> Result<()> {
        let changes = Changes {
            state: &self.state,
            bodies: &self.bodies,
            has_other_bodies,
            new_steps: &std::mem::take(&mut self.limits.new_steps),
            is_after_end,
        };
        for (_, output) in &mut self.outputs {
            output.note_changes(&changes)?;
        }
        Ok(())
    }

    /// Output that is due at this step. `over`: the test has ended.
    fn due(&self, over: bool) -> Due {
        let (state, schedule, progress) = (&self.state, &self.schedule, &self.progress);
        let end_s = self.scene.run.end_time_s;
        let end = over || state.time_s + 0.5 * state.time_step_s >= end_s;
        let first = state.steps == 0;
        let frame = (schedule.frame_s).map_or(first, |s| due(state, s, progress.next_frame));
        let checkpoint = schedule.checkpoint_s;
        Due {
            end,
            row: end || due(state, schedule.row_s, progress.next_row),
            frame: end || frame,
            checkpoint: checkpoint.is_some_and(|s| due(state, s, progress.next_checkpoint)),
            output: self.outputs.iter().any(|(_, output)| output.is_due(state)),
            watchdog: self.watchdog.is_due(state),
        }
    }

    /// The values of all measures, for a row of the time series.
    fn measure(&mut self, balance: &Balance, tell: &dyn Fn(&SoFar)) -> Vec<f64> {
        let state = &self.state;
        self.progress.next_row = next(state, self.schedule.row_s);
        let values = read_probes(&mut self.probes, state, balance);
        self.progress.exceeded = exceeded(&self.probes, &values);
        let end_s = self.scene.run.end_time_s;
        self.progress.last_tenth.note(state, end_s, &values);
        tell(&SoFar {
            fraction: (state.time_s / end_s).min(1.0),
            time_s: state.time_s,
            broken_bonds: state.broken_count,
        });
        values
    }

    /// Decides whether the state after this step is saved. The ledger of this step has been
    /// checked, so only a valid state is saved. Checking it only in order to save would change its
    /// later values.
    fn plan_checkpoint(&mut self, due: Due) {
        let every_s = self.schedule.checkpoint_s;
        let is_late = every_s.is_none() && self.saved.elapsed() >= CHECKPOINT_EVERY;
        self.is_checkpoint_due = due.checkpoint || (due.row && is_late);
        if self.is_checkpoint_due {
            self.progress.next_checkpoint = every_s.map_or(0, |s| next(&self.state, s));
        }
    }

    /// Applies new numbers of particles after bodies have been added, removed or replaced. Returns
    /// whether clumps have become clusters. None: the bodies are the same.
    pub(super) fn follow_population(&mut self) -> Option<bool> {
        let events = &self.state.scratch.events;
        if events.population.is_empty() && events.renumberings.is_empty() {
            return None;
        }
        let is_swap = |one: &PopulationEvent| matches!(one, PopulationEvent::Replaced { .. });
        let replaced = events.population.iter().any(is_swap);
        self.progress.monitors.note_population(&events.population);
        for by in &events.renumberings {
            renumber(&mut self.bodies, by);
        }
        let renumberings = std::mem::take(&mut self.state.scratch.events.renumberings);
        renumber_probes(
            &mut self.probes,
            &renumberings,
            &self.bodies,
            &mut self.state,
        );
        Some(replaced)
    }

    /// Writes a checkpoint, if results are kept.
    pub(super) fn save(&mut self) -> Result<()> {
        let Some((folder, fingerprint)) = self.settings.folder.zip(self.fingerprint) else {
            return Ok(());
        };
        self.state.forget_what_is_near();
        save_outputs(&self.outputs, folder.path(), &mut self.progress)?;
        let snapshot = Snapshot::taken(
            &self.state,
            &self.bodies,
            self.scene.describe(),
            fingerprint,
            self.probes.iter().map(|probe| probe.history).collect(),
            self.progress.clone(),
        );
        write_checkpoint(&folder.file(names::CHECKPOINT), &snapshot.to_bytes()?)
    }

    /// The end of a run that does not reach its end time.
    fn ended_early(&mut self, by: &'static str, problem: Diagnostic) -> Ended {
        let problem = Some(self.with_checkpoint(problem));
        Ended::new(by, balance(&mut self.state), problem)
    }

    /// Adds to a message that the run can be resumed from its checkpoint, if there is one.
    fn with_checkpoint(&self, mut problem: Diagnostic) -> Diagnostic {
        let checkpoint = self
            .settings
            .folder
            .map(|folder| folder.file(names::CHECKPOINT));
        if let Some(path) = checkpoint.filter(|path| path.is_file()) {
            problem.remedy += &format!(
                "; --resume takes it up from '{}' with that step",
                path.display()
            );
        }
        problem
    }

    fn interruption(&self) -> Diagnostic {
        let remedy = match self.settings.folder {
            Some(folder) => format!(
                "go on with the same command and --resume: '{}' holds its state",
                folder.file(names::CHECKPOINT).display()
            ),
            None => "with --output FOLDER its state would have been kept".to_owned(),
        };
        let time_s = significant(self.state.time_s, 6);
        let steps = self.state.steps;
        Diagnostic::interrupted(format!("interrupted at {time_s} s, step {steps}"), remedy)
    }
}

/// The first measure with a value above that at which it ends the run, and that value.
fn exceeded(probes: &[Probe], values: &[f64]) -> Option<(String, f64)> {
    probes.iter().zip(values).find_map(|(probe, &value)| {
        let limit = probe.measure.end_run_above?;
        (value > limit).then(|| (probe.name.clone(), limit))
    })
}

/// Adds the time since then, if any, to the stage of work that few steps need.
fn book(state: &mut State, stage: &Stage, since: Option<Instant>) {
    if let Some(since) = since {
        let clock = &mut state.scratch.clock;
        clock.book_since(number_of(stage), since);
        clock.did(number_of(stage), 1);
    }
}
