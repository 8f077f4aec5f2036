//! A run: a plan is stepped to its end, watched, measured and written down.

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use dem_io::checkpoint::write_checkpoint;
use dem_io::results::{Event, EventFile, FrameFiles, ResultsFolder, SeriesFile, write_json};
use dem_io::scene::Scene;
use dem_io::{Diagnostic, Result};
use serde::{Deserialize, Serialize};

use crate::check::ledger::{Balance, balance};
use crate::check::limit::limit;
use crate::check::watchdog::Watchdog;
use crate::clock::Stage;
use crate::measure::{Gauge, gauges, read_gauges};
use crate::output::frames::FrameOrder;
use crate::output::plots::write_plots;
use crate::output::series;
use crate::output::summary::Summary;
use crate::physics::bond::failure::Cause;
use crate::plan::Plan;
use crate::snapshot::{Snapshot, fingerprint};
use crate::state::State;
use crate::step::{act, move_on};

/// Steps between two looks at the limit of the step, while bonds are strained.
const LIMIT_EVERY: u64 = 20_000;
/// Elastic energy over that of all bonds stretched by 1e-6, above which the limit may have fallen: a mean strain of 1e-3.
const STRAINED: f64 = 1e6;
/// Rows of the time series unless asked otherwise.
const ROWS: f64 = 1000.0;

/// Where the output of a run stands.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    next_row: u64,
    next_frame: u64,
    next_checkpoint: u64,
    series_bytes: u64,
    events_bytes: u64,
    frame_times_s: Vec<f64>,
    largest_errors: [f64; 3],
    /// Since when the kinetic energy has been small against the elastic, s.
    calm_since_s: Option<f64>,
}

/// How a run is told to go.
#[derive(Debug)]
pub struct RunSettings<'a> {
    /// Where results go. None: nowhere.
    pub folder: Option<&'a ResultsFolder>,
    /// Where to go on from. None: from the start.
    pub resume: Option<Snapshot>,
    /// Threads, as said in the summary.
    pub threads: usize,
    /// Set when the run is to stop.
    pub interrupted: &'a AtomicBool,
}

/// Files that grow during a run.
struct Files<'a> {
    folder: &'a ResultsFolder,
    series: SeriesFile,
    events: EventFile,
    frames: FrameFiles,
    order: FrameOrder,
}

/// Steps a plan to its end. `tell` is called now and then with the share of the end time reached, in 0..1.
///
/// # Errors
/// The run goes unstable (exit code 3), is interrupted, or its files cannot be written (1).
pub fn run(
    plan: Plan,
    scene: &Scene,
    settings: RunSettings<'_>,
    tell: &dyn Fn(f64),
) -> Result<Summary> {
    let mut gauges = gauges(scene, &plan);
    let Plan {
        mut state,
        bodies,
        step: choice,
        stages,
        ..
    } = plan;
    let fingerprint = fingerprint(&state);
    let order = settings.folder.map(|_| FrameOrder::new(&bodies, &state));
    let mut progress = Progress::default();
    if let Some(snapshot) = &settings.resume {
        snapshot.restore(&mut state)?;
        progress = snapshot.progress.clone();
        for (gauge, history) in gauges.iter_mut().zip(&snapshot.measures) {
            gauge.history = *history;
        }
    }
    let columns = series::columns(&gauges);
    let mut files = match (settings.folder, order) {
        (Some(folder), Some(order)) => Some(Files {
            folder,
            series: if settings.resume.is_some() {
                SeriesFile::continue_at(&folder.series(), &columns, progress.series_bytes)?
            } else {
                SeriesFile::create(&folder.series(), &columns)?
            },
            events: if settings.resume.is_some() {
                EventFile::continue_at(&folder.events(), progress.events_bytes)?
            } else {
                EventFile::create(&folder.events())?
            },
            frames: if settings.resume.is_some() {
                FrameFiles::continue_at(folder, progress.frame_times_s.clone())?
            } else {
                FrameFiles::create(folder)
            },
            order,
        }),
        _ => None,
    };

    let output = scene.output.clone().unwrap_or_default();
    let end_s = scene.run.end_time_s;
    let row_s = output.series_s.unwrap_or(end_s / ROWS);
    let mut watchdog = Watchdog::new(choice.share_of_limit());
    let mut limit_s = choice.limit.step_s;
    let first_step = state.steps;
    let clock = Instant::now();
    let (ended_by, last) = loop {
        act(&mut state);
        if let Some(files) = &mut files {
            write_breaks(&state, &bodies_bonds(&bodies), files)?;
        }
        let ends = state.time_s + 0.5 * state.time_step_s >= end_s;
        let row_due = ends || due(&state, row_s, progress.next_row);
        let frame_due = ends
            || output
                .frames_s
                .map_or(state.steps == 0, |s| due(&state, s, progress.next_frame));
        let mut balanced = None;
        if row_due || watchdog.is_due(&state) {
            let balance = balance(&mut state);
            watchdog.look(&state, &balance)?;
            progress.note(&state, &balance, scene.run.rest);
            balanced = Some(balance);
        }
        if let (true, Some(balance)) = (row_due, &balanced) {
            progress.next_row = next(&state, row_s);
            let values = read_gauges(&mut gauges, &state, balance);
            if let Some(files) = &mut files {
                let row = series::row(balance, state.broken_count, state.time_step_s, &values);
                files.series.append(state.time_s, &row)?;
            }
            tell((state.time_s / end_s).min(1.0));
        }
        let rests = progress.has_rested(&state);
        if let (true, Some(files)) = (frame_due || rests, &mut files) {
            progress.next_frame = output.frames_s.map_or(0, |s| next(&state, s));
            files.order.write(&state, &mut files.frames)?;
        }
        if let (true, Some(balance)) = (ends || rests, balanced) {
            break (if ends { "end time" } else { "rest" }, balance);
        }
        move_on(&mut state);

        let interrupted = settings.interrupted.load(Ordering::Relaxed);
        let checkpoint_due = output
            .checkpoint_s
            .is_some_and(|s| due(&state, s, progress.next_checkpoint));
        if let (true, Some(files)) = (interrupted || checkpoint_due, &mut files) {
            progress.next_checkpoint = output.checkpoint_s.map_or(0, |s| next(&state, s));
            save(&state, fingerprint, &gauges, &mut progress, files)?;
        }
        if interrupted {
            return Err(interruption(&state, files.as_ref()));
        }
        if state.steps.is_multiple_of(LIMIT_EVERY)
            && watchdog.last_elastic_j > STRAINED * state.ledger.floor_j()
        {
            limit_s = limit(&mut state).step_s;
            follow_limit(&mut state, limit_s, scene, files.as_mut())?;
        }
    };
    let wall_s = clock.elapsed().as_secs_f64();
    if let Some(files) = &mut files {
        // A run that has ended can be taken further with a later end time.
        let mut after = state.clone();
        move_on(&mut after);
        save(&after, fingerprint, &gauges, &mut progress, files)?;
    }
    let steps_per_s = (state.steps - first_step) as f64 / wall_s;
    let summary = Summary {
        scene: scene.source.clone(),
        program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
        ended_by: ended_by.to_owned(),
        simulated_s: state.time_s,
        wall_s,
        threads: settings.threads,
        particles: state.particles.len(),
        bonds: state.bonds.len(),
        broken_bonds: state.broken_count,
        steps: state.steps,
        time_step_s: state.time_step_s,
        limit_s,
        share_of_limit: state.time_step_s / limit_s,
        steps_per_s,
        bond_steps_per_s: steps_per_s * state.bonds.len() as f64,
        energy_error: progress.largest_errors[0],
        momentum_error: progress.largest_errors[1],
        angular_momentum_error: progress.largest_errors[2],
        ledger: last,
        measures: gauges.iter().map(Gauge::result).collect(),
        time_by_stage: Stage::ALL
            .iter()
            .map(|&stage| (stage.name().to_owned(), state.clock.share(stage)))
            .collect(),
        left_out: stages
            .iter()
            .filter(|s| !s.needed)
            .map(|s| s.name.to_owned())
            .collect(),
        results: settings
            .folder
            .map(|folder| folder.path().display().to_string()),
    };
    if let Some(files) = &files {
        files.series.sync()?;
        files.events.sync()?;
        write_json(&files.folder.summary(), &summary)?;
        write_plots(files.folder, &gauges)?;
    }
    Ok(summary)
}

/// Whether the next of the times 0, `every_s`, 2 `every_s`, ... has been reached.
fn due(state: &State, every_s: f64, next: u64) -> bool {
    state.time_s + 0.5 * state.time_step_s >= next as f64 * every_s
}

/// Number of the first of those times that is still to come.
fn next(state: &State, every_s: f64) -> u64 {
    ((state.time_s + 0.5 * state.time_step_s) / every_s).floor() as u64 + 1
}

impl Progress {
    fn note(&mut self, state: &State, balance: &Balance, rest: Option<f64>) {
        let errors = [
            balance.energy_error,
            balance.momentum_error,
            balance.angular_momentum_error,
        ];
        for (largest, error) in self.largest_errors.iter_mut().zip(errors) {
            *largest = largest.max(error.abs());
        }
        if let Some(share) = rest {
            let calm = balance.kinetic_j <= share * balance.elastic_j();
            self.calm_since_s = calm.then(|| self.calm_since_s.unwrap_or(state.time_s));
        }
    }

    /// Whether it has been calm during the last fifth of the run.
    fn has_rested(&self, state: &State) -> bool {
        self.calm_since_s.is_some_and(|since_s| {
            state.time_s > 0.0 && state.time_s - since_s >= 0.2 * state.time_s
        })
    }
}

/// For each bond of the state, its number in the body's file.
fn bodies_bonds(bodies: &[crate::plan::bodies::PlacedBody]) -> impl Fn(usize) -> u64 + '_ {
    move |at| {
        let body = bodies
            .iter()
            .find(|b| b.first_bond <= at && at < b.first_bond + b.bonds.len());
        body.map_or(0, |b| u64::from(b.bonds[at - b.first_bond]))
    }
}

fn write_breaks(
    state: &State,
    number_of: &dyn Fn(usize) -> u64,
    files: &mut Files<'_>,
) -> Result<()> {
    let events: Vec<Event<'_>> = state
        .broken
        .iter()
        .map(|broken| {
            let [a, b] = state.bonds.ends[broken.bond as usize];
            Event {
                step: state.steps,
                time_s: state.time_s,
                kind: "bond_broken",
                bond: Some(number_of(broken.bond as usize)),
                particle_a: Some(files.order.number_of(a)),
                particle_b: Some(files.order.number_of(b)),
                position_m: Some(broken.place_m),
                cause: match broken.cause {
                    Cause::Tension => "tension",
                    Cause::Compression => "compression",
                    Cause::Shear => "shear",
                    Cause::VonMises => "von_mises",
                },
                energy_j: Some(broken.released_j),
                detail: "",
            }
        })
        .collect();
    files.events.append(&events)
}

fn save(
    state: &State,
    fingerprint: u64,
    gauges: &[Gauge],
    progress: &mut Progress,
    files: &mut Files<'_>,
) -> Result<()> {
    files.series.sync()?;
    files.events.sync()?;
    progress.series_bytes = files.series.length_bytes();
    progress.events_bytes = files.events.length_bytes();
    progress.frame_times_s = files.frames.times_s().to_vec();
    let measures = gauges.iter().map(|gauge| gauge.history).collect();
    let snapshot = Snapshot::taken(state, fingerprint, measures, progress.clone());
    write_checkpoint(&files.folder.checkpoint(), &snapshot.to_bytes()?)
}

fn interruption(state: &State, files: Option<&Files<'_>>) -> Diagnostic {
    let remedy = match files {
        Some(files) => format!(
            "go on with the same command and --resume: '{}' holds its state",
            files.folder.checkpoint().display()
        ),
        None => "with --out FOLDER its state would have been kept".to_owned(),
    };
    Diagnostic::failed(
        "",
        format!(
            "interrupted at {:.6e} s, step {}",
            state.time_s, state.steps
        ),
        remedy,
    )
}

/// Takes a smaller step where the limit has fallen below the one that was taken, and notes it.
fn follow_limit(
    state: &mut State,
    limit_s: f64,
    scene: &Scene,
    files: Option<&mut Files<'_>>,
) -> Result<()> {
    let largest = scene.run.safety * limit_s;
    if scene.run.time_step_s.is_some() || state.time_step_s <= largest {
        return Ok(());
    }
    let detail = format!("time step {:.4e} s -> {largest:.4e} s", state.time_step_s);
    state.time_step_s = largest;
    let Some(files) = files else {
        return Ok(());
    };
    files.events.append(&[Event {
        step: state.steps,
        time_s: state.time_s,
        kind: "time_step",
        bond: None,
        particle_a: None,
        particle_b: None,
        position_m: None,
        cause: "limit",
        energy_j: None,
        detail: &detail,
    }])
}
