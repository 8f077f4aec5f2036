//! The end of a run: its summary and its last files.

pub(crate) mod summary_parts;

use dem_io::Result;
use dem_io::units::significant;
use dem_results::folder::names;
use dem_results::summary::{AdaptiveSummary, Summary, Verdict};
use dem_results::{ResultsFolder, write_json};

use super::begin::Run;
use super::doubts::past_outlets::{past_outlets, past_walls};
use super::last_files::{End, LastState};
use super::nothing_happened::{empty_measures, parted_without_contacts, zero_measures};
use super::observe::{AT_END_TIME, Ended, INTERRUPTION};
use super::outcome::Outcome;
use super::outputs::pictures::taken_until;
use super::rigid_hits::RigidHits;
use crate::end::summary_parts::{
    part_error_above, population_summary, sleep_summary, wall_summaries,
};
use crate::last_files::flows::body_flows;
use crate::last_files::fragments::fragment_summary;
use crate::last_files::wall_loads::wall_load_summary;
use crate::machine::{machine, processor_time_s};
use dem_engine::check::watchdog::relaxation_remedy;
use dem_engine::state::clusters::fragments as fragments_of;
use dem_engine::state::clusters::fragments::Fragment;
use dem_engine::step::{advance, number_of, stages};
use dem_laboratory::test_result::TestResult;
use dem_plan::measure::Probe;
use dem_plan::measure::sizes::Fragments;

impl Run<'_> {
    /// Writes the remaining files and the summary.
    pub(super) fn end(mut self, ended: Ended) -> Result<Outcome> {
        let folder = self.settings.folder;
        let (state, progress) = (&self.state, &self.progress);
        let test = self.watch.take();
        let test = test.map(|watch| watch.finish(&progress.test, state, folder));
        let clusters = state.clusters.as_ref();
        let fragments = clusters.map(|c| fragments_of(c, &state.particles, &state.clumps, None));
        self.progress
            .monitors
            .look_at_edges(&self.state, &self.bodies);
        let pieces = fragments.as_deref().unwrap_or_default();
        let is_stopped = ended.problem.is_some();
        let monitors = &self.progress.monitors;
        let mut warnings = std::mem::take(&mut self.planned.warnings);
        let flying = monitors
            .flying(&self.state, self.scene, pieces)
            .filter(|_| !is_stopped);
        let (flies, bodies) = (flying.as_ref(), &self.bodies);
        warnings.extend(monitors.warnings(&self.state, self.scene, bodies, flies, is_stopped));
        if !is_stopped {
            warnings.extend(past_outlets(&self.state, pieces));
            warnings.extend(self.rigid_hits().warnings(self.scene));
            warnings.extend(empty_measures(
                &self.state,
                self.scene,
                &self.probes,
                monitors,
            ));
            warnings.extend(self.probes.iter().filter_map(Probe::coarse_cells));
        }
        if !is_stopped && self.scene.test.is_none() {
            let (last_tenth, touched) =
                (&self.progress.last_tenth, |n| monitors.has_touched_wall(n));
            warnings.extend(last_tenth.short_servos(&self.state, touched));
            if ended.by == AT_END_TIME {
                warnings.extend(monitors.ends_in_an_impact(&self.state));
                warnings.extend(last_tenth.moving(&self.state, bodies, &self.probes));
            }
        }
        if ended.by == AT_END_TIME && self.progress.exceeded.is_none() {
            warnings.extend(self.probes.iter().filter_map(Probe::end_not_reached));
        }
        if let (0, Some((name, limit))) = (self.state.steps, &self.progress.exceeded) {
            warnings.push(format!(
                "measures.{name} ended the run before its first step: it is above its end_run_above of {} from the start; set a larger one",
                significant(*limit, 4)
            ));
        }
        let mut summary = self.summary(&ended, fragments.as_deref(), test.transpose()?);
        let note = flying.filter(|flying| !flying.may_break);
        summary.notes.extend(note.map(|flying| flying.text));
        summary.notes.extend(parted_without_contacts(&self.state));
        if !is_stopped {
            let pieces = fragments.as_deref().unwrap_or_default();
            summary.notes.extend(self.notes(pieces));
        }
        let outputs = self.outputs.iter();
        (summary.notes).extend(outputs.filter_map(|(_, output)| output.note(&self.state)));
        let coarse = std::mem::take(&mut self.planned.coarse);
        let remedy = relaxation_remedy(&self.state);
        summary.judge(warnings, coarse, self.planned.is_granular, remedy);
        match folder {
            None => {}
            // Of what has been simulated; its film goes on with the run.
            Some(folder) if ended.by == INTERRUPTION => {
                let end = self.end_with_tables(&summary, folder)?;
                end.write(folder, &self.probes, None)?;
            }
            Some(folder) if is_stopped => {
                let end = End::of(&summary)?;
                end.write_page(folder)?;
                end.write_summary(folder)?;
            }
            Some(folder) => self.write_end(&summary, folder)?,
        }
        Ok(Outcome {
            summary,
            problem: ended.problem,
        })
    }

    /// Notes on a run that was not stopped, and its pieces.
    fn notes(&self, pieces: &[Fragment]) -> Vec<String> {
        let mut notes = self.progress.monitors.beyond_after_the_peak();
        notes.extend(zero_measures(&self.probes));
        notes.extend(past_walls(&self.state, pieces));
        notes
    }

    /// The hits of rigid clumps, those that go on included. A continued run goes on with them.
    fn rigid_hits(&self) -> RigidHits {
        let mut hits = self.progress.monitors.rigid_hits.clone();
        let state = &self.state;
        hits.take(&mut state.clumps.clone(), state.time_s, true);
        let mut parts = state.rigid_parts.clone();
        let last = (state.time_s, true);
        hits.take_of_parts(&mut parts, &state.bonds, &self.bodies, last);
        hits
    }

    /// The last checkpoint, from which the run can be continued to a later end time; plots, film
    /// and summary.
    fn write_end(&mut self, summary: &Summary, folder: &ResultsFolder) -> Result<()> {
        let end = self.end_with_tables(summary, folder)?;
        // The second half of the last step, which a continued run begins with. Bodies that it adds,
        // removes or replaces are not in the results.
        advance(&mut self.state);
        let changed = self.follow_population();
        self.note_changes(changed.is_some(), true)?;
        write_json(&folder.file(names::ENDED), &end)?;
        self.save()?;
        let pictures = taken_until(self.scene, &self.progress)?;
        end.write(folder, &self.probes, pictures)
    }

    /// Writes the tables of this state, the last of the run.
    fn end_with_tables(&self, summary: &Summary, folder: &ResultsFolder) -> Result<End> {
        End::with_tables(
            summary,
            &LastState {
                folder,
                scene: self.scene,
                state: &self.state,
                fragments: Fragments::of(&self.state),
                end_s: summary.simulated_s,
                probes: &self.probes,
            },
        )
    }

    fn summary(
        &mut self,
        ended: &Ended,
        fragments: Option<&[Fragment]>,
        test: Option<TestResult>,
    ) -> Summary {
        let (state, progress, scene) = (&self.state, &self.progress, self.scene);
        let wall_s = self.began.elapsed().as_secs_f64();
        let processor_s = processor_time_s().zip(self.processor_before_s);
        let [energy_error, momentum_error, angular_momentum_error] =
            progress.largest_errors(&ended.balance);
        let steps_per_s = (state.steps - self.first_step) as f64 / wall_s;
        let bonds = if state.model.rules.are_none() {
            state.bonds.len() as f64
        } else {
            // Mean over the entire run, as the number of bonds changes.
            state.population.bond_steps[0] as f64 / state.steps.max(1) as f64
        };
        let of_state = state.clusters.as_ref().zip(fragments);
        let left_out = self.planned.stages.iter().filter(|stage| !stage.needed);
        let fraction = |stage| state.scratch.clock.fraction(number_of(stage));
        Summary {
            scene: scene.source.clone(),
            program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
            engine: None,
            ended_by: ended.by.to_owned(),
            problem: ended.problem.as_ref().map(ToString::to_string),
            inputs: self.planned.inputs.clone(),
            simulated_s: state.time_s,
            resumed_at_s: (self.first_step > 0).then_some(self.first_time_s),
            wall_s,
            processor_s: processor_s.map(|(after, before)| after - before),
            threads: self.settings.threads,
            machine: machine(),
            particles: state.particles.len(),
            bonds: state.bonds.len(),
            bodies: self.planned.masses.clone(),
            broken_bonds: state.broken_count,
            largest_bond_strain: progress.monitors.bond_strain.largest,
            largest_overlap: progress.monitors.largest_overlap,
            broken_by_cause: state.broken_by_cause,
            damaged_bonds: state.bonds.count_damaged(),
            yielded_bonds: state.bonds.count_yielded(),
            sizes: Fragments::of(state).map(|fragments| fragments.sizes(&state.model)),
            fragments: of_state.map(|(all, own)| fragment_summary(all, own, &state.population)),
            population: population_summary(state, &self.bodies),
            flows: body_flows(state, &self.planned.masses),
            taken_in: progress.monitors.taken.summary(state),
            wall_loads: wall_load_summary(state),
            walls: wall_summaries(scene, state),
            sleep: state.sleep.as_ref().map(sleep_summary),
            steps: state.steps,
            time_step_s: state.time_step_s,
            adaptive: scene.run.adaptive.then(|| AdaptiveSummary {
                smallest_step_s: progress.steps_s[0],
                largest_step_s: progress.steps_s[1],
                changes: progress.step_changes,
            }),
            limit_s: progress.limit_s,
            fraction_of_limit: state.time_step_s / progress.limit_s,
            steps_per_s,
            bond_steps_per_s: steps_per_s * bonds,
            energy_error,
            part_error: part_error_above(energy_error, state),
            momentum_error,
            angular_momentum_error,
            balance: ended.balance,
            measures: self.probes.iter().map(Probe::result).collect(),
            time_by_stage: (stages().iter())
                .map(|stage| (stage.name.to_owned(), fraction(stage)))
                .collect(),
            inactive_stages: left_out.map(|stage| stage.stage.name.to_owned()).collect(),
            notes: self.planned.notes.clone(),
            verdict: Verdict::default(),
            results: (self.settings.folder).map(|folder| folder.path().display().to_string()),
            resumed_with: self.planned.changed_step.clone(),
            test,
            equilibrium: None,
        }
    }
}
