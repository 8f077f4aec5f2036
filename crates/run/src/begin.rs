//! The beginning of a run, before its first step.

use std::collections::BTreeMap;
use std::time::Instant;

use dem_io::Result;
use dem_io::body::mass::BodyMass;
use dem_scene::Scene;

use super::limits::Limits;
use super::new_step::change_step;
use super::outputs::list::open_outputs;
use super::outputs::{Opening, Outputs, Start};
use super::progress::Progress;
use super::schedule::OutputSchedule;
use super::settings::RunSettings;
use crate::machine::processor_time_s;
use crate::snapshot::fingerprint;
use dem_engine::check::watchdog::Watchdog;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_plan::measure::{History, Probe, place_watches, probes, renumber as renumber_probes};
use dem_plan::{Plan, PlannedStage};
use dem_results::folder::names;
use dem_results::summary::Inputs;
use dem_rig::watch::Watch;

/// A run: the plan that is stepped, and its monitors.
pub(super) struct Run<'a> {
    pub(super) scene: &'a Scene,
    pub(super) settings: RunSettings<'a>,
    pub(super) state: State,
    pub(super) bodies: Vec<PlacedBody>,
    /// Measures.
    pub(super) probes: Vec<Probe>,
    /// The laboratory test. None: the scene has none.
    pub(super) watch: Option<Watch<'a>>,
    pub(super) watchdog: Watchdog,
    pub(super) limits: Limits<'a>,
    pub(super) progress: Progress,
    pub(super) schedule: OutputSchedule,
    /// Empty: no results are kept.
    pub(super) outputs: Outputs,
    /// See [`super::snapshot::fingerprint`]. None: no results are kept.
    pub(super) fingerprint: Option<u64>,
    /// Whether a checkpoint is to be written after the step.
    pub(super) is_checkpoint_due: bool,
    /// Wall time of the last checkpoint.
    pub(super) saved: Instant,
    /// Parts of the plan that the summary repeats.
    pub(super) planned: Planned,
    pub(super) first_step: u64,
    /// Time at which this part of the run began, s.
    pub(super) first_time_s: f64,
    pub(super) began: Instant,
    pub(super) processor_before_s: Option<f64>,
}

/// Parts of the plan that the summary repeats.
pub(super) struct Planned {
    pub(super) stages: Vec<PlannedStage>,
    pub(super) masses: BTreeMap<String, BodyMass>,
    pub(super) notes: Vec<String>,
    pub(super) warnings: Vec<String>,
    pub(super) coarse: Vec<String>,
    /// Whether the spheres of all bodies that can break are grains.
    pub(super) is_granular: bool,
    pub(super) inputs: Inputs,
    /// Change of the time step in a resumed run.
    pub(super) changed_step: Option<String>,
}

impl<'a> Run<'a> {
    /// Begins a run, or resumes one; refuses a checkpoint of another scene or of a finished run.
    pub(super) fn begin(plan: Plan, scene: &'a Scene, settings: RunSettings<'a>) -> Result<Self> {
        let mut settings = settings;
        let mut probes = probes(scene, &plan);
        let watch = watch_of_test(scene, &plan, &mut settings);
        let Plan {
            mut state,
            mut bodies,
            step: choice,
            ..
        } = plan;
        place_watches(&probes, &mut state);
        let start = (settings.folder).map(|folder| (folder, Start::of(scene, &state, &bodies)));
        let size = state.particles.len() + state.bonds.len();
        let schedule = OutputSchedule::of(scene, choice.step_s, size);
        let mut progress = Progress::new(schedule, &choice);
        let mut limits = Limits::of(scene, &state, &choice);
        let mut changed_step = None;
        let fingerprint = (settings.folder.map(|_| fingerprint(&state))).transpose()?;
        let resumed = settings.resume.take().zip(fingerprint);
        let is_continued = resumed.is_some();
        if let Some((snapshot, fingerprint)) = resumed {
            let place = (settings.folder).map(|f| f.file(names::CHECKPOINT).display().to_string());
            (snapshot.check_scene(&scene.describe()))
                .and_then(|()| snapshot.restore(fingerprint, &mut state, &mut bodies))
                .map_err(|error| error.within(&place.unwrap_or_default()))?;
            progress = snapshot.progress;
            progress.go_on(&state, schedule, scene)?;
            progress.plain.step_s = progress.plain.step_s.min(choice.replaced.step_s);
            restore_histories(&mut probes, snapshot.measures, &bodies, &mut state);
            changed_step = change_step(&mut state, &choice, scene.run.adaptive);
        }
        limits.new_steps.extend(changed_step.clone());
        let outputs = match &start {
            None => Vec::new(),
            Some((folder, start)) => open_outputs(&Opening {
                name: "",
                folder,
                scene,
                state: &state,
                bodies: &bodies,
                probes: &probes,
                start,
                continued: is_continued.then_some(&progress),
            })?,
        };
        let mut run = Self {
            scene,
            settings,
            bodies,
            probes,
            watch,
            watchdog: Watchdog::new(choice.fraction_of_limit()),
            limits,
            progress,
            schedule,
            outputs,
            fingerprint,
            is_checkpoint_due: false,
            saved: Instant::now(),
            planned: Planned {
                stages: plan.stages,
                masses: plan.masses,
                notes: plan.notes,
                coarse: plan.coarse,
                is_granular: plan.is_granular,
                warnings: plan.warnings,
                inputs: plan.inputs,
                changed_step: changed_step.map(|new| new.detail),
            },
            first_step: state.steps,
            first_time_s: state.time_s,
            state,
            began: Instant::now(),
            processor_before_s: processor_time_s(),
        };
        if !run.limits.new_steps.is_empty() {
            run.note_changes(false, false)?;
        }
        Ok(run)
    }
}

/// Gives measures the values that they had at a checkpoint.
fn restore_histories(
    probes: &mut [Probe],
    histories: Vec<History>,
    bodies: &[PlacedBody],
    state: &mut State,
) {
    for (probe, history) in probes.iter_mut().zip(histories) {
        probe.history = history;
    }
    if state.bodies_change() {
        renumber_probes(probes, &[], bodies, state);
    }
}

/// The laboratory test of the scene, watched. None: the scene has none.
fn watch_of_test<'a>(
    scene: &'a Scene,
    plan: &Plan,
    settings: &mut RunSettings<'_>,
) -> Option<Watch<'a>> {
    let of_test = settings.test.take()?;
    let (test, setup) = (scene.test.as_ref()?, settings.setup.take()?);
    Some(Watch::new(scene, test, setup, of_test, plan))
}
