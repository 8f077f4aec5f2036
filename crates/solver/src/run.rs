//! A run: a plan is stepped to its end, watched, measured and written down.

mod events;
mod finish;
mod fragments;
mod limits;
mod pictures;
mod progress;
mod seen;

use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use dem_io::checkpoint::write_checkpoint;
use dem_io::results::{EventFile, FragmentFile, FrameFiles, ResultsFolder, SeriesFile, write_json};
use dem_io::scene::{Integrator, Scene};
use dem_io::{Diagnostic, Result};

use crate::check::ledger::{Balance, balance};
use crate::check::watchdog::Watchdog;
use crate::clock::Stage;
use crate::clusters::fragments as fragments_of;
use crate::laboratory::watch::{TestSettings, Watch};
use crate::machine::{machine, processor_time_s};
use crate::measure::{Probe, place_watches, probes, read_probes, renumber as renumber_probes};
use crate::output::fragments::FragmentSummary;
use crate::output::frames::FrameOrder;
use crate::output::series;
use crate::output::summary::{AdaptiveSummary, PopulationSummary, SleepSummary, Summary, Verdict};
use crate::plan::Plan;
use crate::plan::bodies::{PlacedBody, renumber};
use crate::snapshot::{Snapshot, fingerprint};
use crate::stages::clumps::place_all;
use crate::stages::replacement::{PopulationEvent, replace};
use crate::state::State;
use crate::step::{act, find_pieces_now, move_on};

use self::events::{
    change_step, new_step, write_breaks, write_happened, write_sleep, write_splits,
};
use self::finish::End;
pub use self::finish::{Finished, finish};
use self::fragments::write_fragments;
use self::limits::{LOOKS_EVERY, Limits, went_through};
use self::pictures::{Order, Pictures};
pub use self::progress::Progress;
use self::progress::{OutputSchedule, due, next};

/// Wall time between two checkpoints where the scene names no other rhythm.
const CHECKPOINT_EVERY: Duration = Duration::from_secs(60);

/// Steps between two looks at how bonds are bent and twisted: each costs about five times what the
/// bonds of a step do.
const EDGES_EVERY: u64 = 1024;

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
    /// What is known of the scene's laboratory test, for which it has been arranged. None: it is not evaluated.
    pub test: Option<TestSettings>,
}

/// Files that grow during a run.
struct Files<'a> {
    folder: &'a ResultsFolder,
    series: SeriesFile,
    events: EventFile,
    frames: FrameFiles,
    /// None: no pictures are wanted.
    pictures: Option<Pictures>,
    /// None: nothing can break into fragments.
    fragments: Option<FragmentFile>,
    order: FrameOrder,
}

impl<'a> Files<'a> {
    /// New files, or those of a run that is `continued` where it stood.
    fn open(
        folder: &'a ResultsFolder,
        order: FrameOrder,
        columns: &[String],
        has_fragments: bool,
        continued: Option<&Progress>,
    ) -> Result<Self> {
        let fragments = has_fragments.then(|| match continued {
            Some(at) => FragmentFile::continue_at(&folder.fragments(), at.fragments_bytes),
            None => FragmentFile::create(&folder.fragments()),
        });
        let (series, events, frames) = match continued {
            Some(at) => (
                SeriesFile::continue_at(&folder.series(), columns, at.series_bytes)?,
                EventFile::continue_at(&folder.events(), at.events_bytes)?,
                FrameFiles::continue_at(folder, at.frame_times_s.clone())?,
            ),
            None => (
                SeriesFile::create(&folder.series(), columns)?,
                EventFile::create(&folder.events())?,
                FrameFiles::create(folder),
            ),
        };
        Ok(Self {
            folder,
            series,
            events,
            frames,
            pictures: None,
            fragments: fragments.transpose()?,
            order,
        })
    }
}

/// How a run ended.
#[derive(Debug, Clone)]
pub struct Outcome {
    /// What came of it, as far as it went.
    pub summary: Summary,
    /// Why it did not come to its end. None: it did.
    pub problem: Option<Diagnostic>,
}

/// What ends the loop over steps.
struct Ended {
    by: &'static str,
    balance: Balance,
    problem: Option<Diagnostic>,
}

impl Ended {
    /// Before the end, with what has happened.
    fn before_the_end(state: &mut State, by: &'static str, problem: Diagnostic) -> Self {
        Self {
            by,
            balance: balance(state),
            problem: Some(problem),
        }
    }
}

/// Steps a plan to its end, or brings it into its equilibrium at once, as the scene says. `tell` is called now and then with the share of the end time reached, in 0..1.
///
/// # Errors
/// The run goes unstable (exit code 3), is interrupted (130), or its files cannot be written (1).
pub fn run(
    plan: Plan,
    scene: &Scene,
    settings: RunSettings<'_>,
    tell: &dyn Fn(f64),
) -> Result<Summary> {
    let outcome = run_as_far_as_it_goes(plan, scene, settings, tell)?;
    outcome.problem.map_or(Ok(outcome.summary), Err)
}

/// The same. A run that goes unstable or is interrupted has a summary as well, in its folder too.
///
/// # Errors
/// Its files cannot be written, or there is no equilibrium to go to.
pub fn run_as_far_as_it_goes(
    plan: Plan,
    scene: &Scene,
    settings: RunSettings<'_>,
    tell: &dyn Fn(f64),
) -> Result<Outcome> {
    if scene.run.integrator == Integrator::Static {
        let summary = crate::statics::run(plan, scene, &settings, tell)?;
        return Ok(Outcome {
            summary,
            problem: None,
        });
    }
    let mut probes = probes(scene, &plan);
    let watch = match (&scene.test, &plan.test, settings.test) {
        (Some(test), Some(setup), Some(of_test)) => {
            Some(Watch::new(scene, test, setup.clone(), of_test, &plan))
        }
        _ => None,
    };
    let Plan {
        mut state,
        mut bodies,
        step: choice,
        stages,
        masses,
        notes,
        mut warnings,
        inputs,
        ..
    } = plan;
    place_watches(&probes, &mut state);
    let fingerprint = fingerprint(&state);
    let mut order = settings.folder.map(|_| FrameOrder::new(&bodies, &state));
    let of_pictures = settings.folder.and(Order::of(scene, &state));
    let size = state.particles.len() + state.bonds.len();
    let rhythm = OutputSchedule::of(scene, choice.step_s, size);
    let mut progress = Progress::new(rhythm, &choice);
    let mut limits = Limits::of(scene, &state, &choice);
    let mut changed_step = None;
    let is_continued = settings.resume.is_some();
    if let Some(snapshot) = settings.resume {
        let place = settings
            .folder
            .map(|f| f.checkpoint().display().to_string());
        snapshot
            .check_scene(&scene.describe())
            .and_then(|()| snapshot.restore(&mut state, &mut bodies))
            .map_err(|error| error.within(&place.unwrap_or_default()))?;
        progress = snapshot.progress;
        progress.go_on(&state, rhythm, scene)?;
        for (probe, history) in probes.iter_mut().zip(snapshot.measures) {
            probe.history = history;
        }
        if !state.clumps.templates.is_empty() {
            renumber_probes(&mut probes, &[], &bodies, &mut state);
            order = order.map(|_| FrameOrder::new(&bodies, &state));
        }
        changed_step = change_step(&mut state, &choice, scene.run.adaptive);
    }
    let columns = series::columns(scene.walls.keys(), &probes);
    let mut files = match (settings.folder, order) {
        (Some(folder), Some(order)) => {
            let continued = is_continued.then_some(&progress);
            let has_fragments = state.clusters.is_some();
            Some(Files::open(
                folder,
                order,
                &columns,
                has_fragments,
                continued,
            )?)
        }
        _ => None,
    };

    if let (Some(order), Some(files)) = (of_pictures, &mut files) {
        let continued = is_continued.then_some((&state, progress.pictures));
        files.pictures = Some(Pictures::open(files.folder, order, continued)?);
    }
    if let (Some(detail), Some(files)) = (&changed_step, &mut files) {
        files
            .events
            .append(&[new_step(&state, "resumed", detail)])?;
    }

    let end_s = scene.run.end_time_s;
    let watchdog = Watchdog::new(choice.share_of_limit());
    let first_step = state.steps;
    let clock = Instant::now();
    let processor_before_s = processor_time_s();
    let mut saved = clock;
    let ended = loop {
        act(&mut state);
        if let Some(problem) = went_through(&state, scene, &bodies) {
            let problem = with_checkpoint(problem, files.as_ref());
            break Ended::before_the_end(&mut state, "instability", problem);
        }
        progress.seen.note_breaks(&state, &bodies);
        if state.steps.is_multiple_of(EDGES_EVERY) {
            progress.seen.look_at_edges(&state, &bodies);
        }
        if state.steps.is_multiple_of(LOOKS_EVERY) {
            progress.seen.look_at_contacts(&state, scene, &bodies);
        }
        if let Some(files) = &mut files {
            write_breaks(&state, &bodies, files)?;
            write_splits(&state, files)?;
        }
        let broke = watch
            .as_ref()
            .is_some_and(|watch| watch.note(&mut progress.test, &state));
        let ends = broke || state.time_s + 0.5 * state.time_step_s >= end_s;
        if ends {
            find_last_pieces(&mut state, files.as_mut())?;
        }
        let row_due = ends || due(&state, rhythm.row_s, progress.next_row);
        let frame_due = ends
            || rhythm
                .frame_s
                .map_or(state.steps == 0, |s| due(&state, s, progress.next_frame));
        let checkpoint_due = rhythm
            .checkpoint_s
            .is_some_and(|s| due(&state, s, progress.next_checkpoint));
        let picture_due = (files.as_ref())
            .and_then(|files| files.pictures.as_ref())
            .is_some_and(|pictures| pictures.are_due(&state));
        let since = state.steps.is_multiple_of(LOOKS_EVERY).then(Instant::now);
        let watchdog_due = watchdog.is_due(&state);
        state.clock.book_checks(since);
        let output_due = row_due || frame_due || checkpoint_due || picture_due || watchdog_due;
        let output_since = output_due.then(Instant::now);
        if output_due {
            place_all(&state.clumps, &mut state.particles);
        }
        let mut rests = false;
        let mut balanced = None;
        // A checkpoint of a run that has gone unstable would be worth nothing.
        if row_due || checkpoint_due || watchdog_due {
            let balance = balance(&mut state);
            if let Err(problem) = watchdog.look(&state, &balance, &bodies) {
                break Ended {
                    by: "instability",
                    balance,
                    problem: Some(with_checkpoint(problem, files.as_ref())),
                };
            }
            progress.note(&state, &balance, rhythm.rest);
            rests = progress.has_rested(&state);
            if rests && !ends {
                find_last_pieces(&mut state, files.as_mut())?;
            }
            balanced = Some(balance);
        }
        if let (true, Some(balance)) = (row_due || rests, &balanced) {
            progress.next_row = next(&state, rhythm.row_s);
            let values = read_probes(&mut probes, &state, balance);
            if let Some(files) = &mut files {
                let row = series::row(&state, balance, &values);
                files.series.append(state.time_s, &row)?;
            }
            tell((state.time_s / end_s).min(1.0));
        }
        if let (true, Some(files)) = (frame_due || rests, &mut files) {
            progress.next_frame = rhythm.frame_s.map_or(0, |s| next(&state, s));
            files.order.write(&state, &mut files.frames)?;
        }
        if let Some(pictures) = files.as_mut().and_then(|files| files.pictures.as_mut())
            && (ends || rests || pictures.are_due(&state))
        {
            pictures.take(&state, &bodies)?;
        }
        let fragments_due = frame_due || rests || (row_due && progress.has_new_fragments(&state));
        if let (true, Some(files)) = (fragments_due, &mut files) {
            write_fragments(&state, &mut progress, files)?;
        }
        // The ledger of this step has been looked at: what is saved is sound. Looking at it only to save would change its later figures.
        let checkpoint_due = checkpoint_due
            || (row_due && rhythm.checkpoint_s.is_none() && saved.elapsed() >= CHECKPOINT_EVERY);
        if checkpoint_due {
            progress.next_checkpoint = rhythm.checkpoint_s.map_or(0, |s| next(&state, s));
        }
        if let (true, Some(balance)) = (ends || rests, balanced) {
            progress.rested = !ends;
            progress.broke = broke;
            let why = match (broke, ends, &watch) {
                (true, ..) => "breakage",
                (false, true, Some(_)) => "end of the stroke",
                (false, true, None) => "end time",
                (false, false, _) => "rest",
            };
            break Ended {
                by: why,
                balance,
                problem: None,
            };
        }
        if let Some(since) = output_since {
            state.clock.book_all(Stage::Output, since.elapsed());
        }
        state.clock.start(state.steps);
        let mut replaced = false;
        if let Some((renumbered, happened)) = replace(&mut state) {
            let is_swap = |one: &PopulationEvent| matches!(one, PopulationEvent::Replaced { .. });
            replaced = happened.iter().any(is_swap);
            progress.seen.note_happened(&happened);
            for by in &renumbered {
                renumber(&mut bodies, by);
            }
            renumber_probes(&mut probes, &renumbered, &bodies, &mut state);
            if let Some(files) = &mut files {
                write_happened(&state, &happened, files)?;
                files.order = FrameOrder::new(&bodies, &state);
            }
        }
        state.clock.book(Stage::Replacement);
        move_on(&mut state);
        if let Some(files) = &mut files {
            write_sleep(&state, files)?;
        }

        let since = state.steps.is_multiple_of(LOOKS_EVERY).then(Instant::now);
        let followed = limits.follow(&mut state, replaced, &mut progress, &bodies, files.as_mut());
        state.clock.book_checks(since);
        if let Err(problem) = followed {
            let problem = with_checkpoint(problem, files.as_ref());
            break Ended::before_the_end(&mut state, "instability", problem);
        }
        let interrupted = settings.interrupted.load(Ordering::Relaxed);
        if let (true, Some(files)) = (interrupted || checkpoint_due, &mut files) {
            saved = Instant::now();
            save(
                &state,
                &bodies,
                scene,
                fingerprint,
                &probes,
                &mut progress,
                files,
            )?;
        }
        if interrupted {
            let problem = interruption(&state, files.as_ref());
            break Ended::before_the_end(&mut state, "interruption", problem);
        }
    };
    let last = ended.balance;
    let [energy_error, momentum_error, angular_momentum_error] = progress.largest_errors(&last);
    let wall_s = clock.elapsed().as_secs_f64();
    let processor_s = processor_time_s().zip(processor_before_s);
    let test = watch
        .map(|watch| watch.finish(&progress.test, &state, progress.broke, settings.folder))
        .transpose()?;
    let steps_per_s = (state.steps - first_step) as f64 / wall_s;
    let fragments = state
        .clusters
        .as_ref()
        .map(|clusters| fragments_of(clusters, &state.particles, &state.clumps, None));
    let pieces = fragments.as_deref().unwrap_or_default();
    progress.seen.look_at_edges(&state, &bodies);
    let is_stopped = ended.problem.is_some();
    let seen = &progress.seen;
    warnings.extend(seen.warnings(&state, scene, &bodies, pieces, is_stopped));
    let of_state = state.clusters.as_ref().zip(fragments.as_ref());
    let mut summary = Summary {
        scene: scene.source.clone(),
        program: concat!("dem-run ", env!("CARGO_PKG_VERSION")).to_owned(),
        ended_by: ended.by.to_owned(),
        problem: ended.problem.as_ref().map(Diagnostic::to_string),
        inputs,
        simulated_s: state.time_s,
        wall_s,
        processor_s: processor_s.map(|(after, before)| after - before),
        threads: settings.threads,
        machine: machine(),
        particles: state.particles.len(),
        bonds: state.bonds.len(),
        bodies: masses,
        broken_bonds: state.broken_count,
        largest_bond_strain: progress.seen.bond_strain.largest,
        largest_overlap: progress.seen.overlap.largest,
        broken_by_cause: state.broken_by_cause,
        fragments: of_state.map(|(clusters, all)| FragmentSummary::new(clusters, all)),
        population: PopulationSummary::of(&state),
        sleep: state.sleep.as_ref().map(SleepSummary::of),
        steps: state.steps,
        time_step_s: state.time_step_s,
        adaptive: scene.run.adaptive.then(|| AdaptiveSummary {
            smallest_step_s: progress.steps_s[0],
            largest_step_s: progress.steps_s[1],
            changes: progress.step_changes,
        }),
        limit_s: progress.limit_s,
        share_of_limit: state.time_step_s / progress.limit_s,
        steps_per_s,
        bond_steps_per_s: if state.rules.are_none() {
            steps_per_s * state.bonds.len() as f64
        } else {
            // Of the whole run, as the number of bonds changes.
            steps_per_s * state.rules.bond_steps[0] as f64 / state.steps.max(1) as f64
        },
        energy_error,
        momentum_error,
        angular_momentum_error,
        ledger: last,
        measures: probes.iter().map(Probe::result).collect(),
        time_by_stage: Stage::ALL
            .iter()
            .map(|&stage| (stage.name().to_owned(), state.clock.share(stage)))
            .collect(),
        left_out: stages
            .iter()
            .filter(|s| !s.needed)
            .map(|s| s.stage.name().to_owned())
            .collect(),
        notes,
        verdict: Verdict::default(),
        results: settings
            .folder
            .map(|folder| folder.path().display().to_string()),
        resumed_with: changed_step,
        test,
        equilibrium: None,
    };
    summary.judge(warnings);
    if let (Some(files), Some(problem)) = (&files, &ended.problem) {
        write_json(&files.folder.summary(), &summary)?;
        return Ok(Outcome {
            summary,
            problem: Some(problem.clone()),
        });
    }
    if let Some(files) = &mut files {
        // A run that has ended can be taken further with a later end time.
        move_on(&mut state);
        write_sleep(&state, files)?;
        let end = End::of(&summary)?;
        write_json(&files.folder.ended(), &end)?;
        save(
            &state,
            &bodies,
            scene,
            fingerprint,
            &probes,
            &mut progress,
            files,
        )?;
        end.write(files.folder, &state, &probes, files.pictures.as_ref())?;
    }
    Ok(Outcome {
        summary,
        problem: ended.problem,
    })
}

/// Looks for pieces once more where bonds have broken since they were looked for last.
fn find_last_pieces(state: &mut State, files: Option<&mut Files<'_>>) -> Result<()> {
    if state.unsearched.is_empty() {
        return Ok(());
    }
    find_pieces_now(state);
    files.map_or(Ok(()), |files| write_splits(state, files))
}

fn save(
    state: &State,
    bodies: &[PlacedBody],
    scene: &Scene,
    fingerprint: u64,
    probes: &[Probe],
    progress: &mut Progress,
    files: &mut Files<'_>,
) -> Result<()> {
    files.series.sync()?;
    files.events.sync()?;
    progress.series_bytes = files.series.length_bytes();
    progress.events_bytes = files.events.length_bytes();
    if let Some(fragments) = &files.fragments {
        fragments.sync()?;
        progress.fragments_bytes = fragments.length_bytes();
    }
    progress.frame_times_s = files.frames.times_s().to_vec();
    if let Some(pictures) = &files.pictures {
        progress.pictures = pictures.taken();
    }
    let measures = probes.iter().map(|probe| probe.history).collect();
    let snapshot = Snapshot::taken(
        state,
        bodies,
        scene.describe(),
        fingerprint,
        measures,
        progress.clone(),
    );
    write_checkpoint(&files.folder.checkpoint(), &snapshot.to_bytes()?)
}

/// Says that the run can be taken up again where it has left a checkpoint.
fn with_checkpoint(mut problem: Diagnostic, files: Option<&Files<'_>>) -> Diagnostic {
    let checkpoint = files.map(|files| files.folder.checkpoint());
    if let Some(path) = checkpoint.filter(|path| path.is_file()) {
        problem.remedy += &format!(
            "; --resume takes it up from '{}' with that step",
            path.display()
        );
    }
    problem
}

fn interruption(state: &State, files: Option<&Files<'_>>) -> Diagnostic {
    let remedy = match files {
        Some(files) => format!(
            "go on with the same command and --resume: '{}' holds its state",
            files.folder.checkpoint().display()
        ),
        None => "with --out FOLDER its state would have been kept".to_owned(),
    };
    Diagnostic::interrupted(
        format!(
            "interrupted at {:.6e} s, step {}",
            state.time_s, state.steps
        ),
        remedy,
    )
}
