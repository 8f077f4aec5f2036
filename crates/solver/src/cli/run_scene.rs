//! `dem-run SCENE`: runs a scene.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use dem_io::diagnostic::Kind;
use dem_io::safe_write::write_visible_json;
use dem_io::text::visible;
use dem_io::{Body, Diagnostic, Result};
use dem_results::checkpoint::read_checkpoint;
use dem_results::folder::names;
use dem_results::folder::refuse_inputs_among_results;
use dem_results::{Existing, ResultsFolder, write_json};
use dem_scene::{Integrator, Scene};
use dem_terminal::colour::{Colour, on_standard_error};
use dem_terminal::standard_output::{
    write_standard_json, write_standard_lines, write_standard_output,
};

use super::as_run;
use super::progress::{ShownProgress, Tell};
use super::scene_arguments::SceneArguments;
use crate::interrupt::Interrupt;
use dem_engine::threads::keep_awake;
use dem_plan::Plan;
use dem_results::summary::{Trust, Unfinished};
use dem_rig::arrange::{arrange, tested_body};
use dem_rig::plan_with_test;
use dem_rig::watch::TestSettings;
use dem_runner::snapshot::Snapshot;
use dem_runner::{
    Finished, INTERRUPTION, Outcome, RunSettings, SoFar, finish, run as run_plan,
    run_as_far_as_it_goes,
};

#[derive(Debug, Args)]
pub(super) struct RunArguments {
    #[command(flatten)]
    pub(super) scene: SceneArguments,
    /// Folder for the results
    #[arg(long, short, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Overwrite the results in the folder
    #[arg(long, conflicts_with = "resume")]
    force: bool,
    /// Resume from the checkpoint in the folder
    #[arg(long)]
    resume: bool,
    /// Files to keep once the run has ended: all, or tables, which removes frames, pictures, plots
    /// and checkpoint
    #[arg(long, value_name = "FILES", default_value = "all", value_parser = ["all", "tables"])]
    keep: String,
    /// Print everything in the summary: masses, steps, speed, time of each stage, notes
    #[arg(long, short, conflicts_with_all = ["json", "quiet"])]
    verbose: bool,
    /// Only print errors: no progress, no warnings, no summary; --json is still printed
    #[arg(long, short)]
    quiet: bool,
}

impl RunArguments {
    /// Refuses options that have no meaning if no scene is run.
    pub(super) fn refuse_scene_options(&self) -> Result<()> {
        let given = [
            ("--output", self.output.is_some()),
            ("--force", self.force),
            ("--resume", self.resume),
            ("--keep", self.keep != "all"),
            ("--verbose", self.verbose),
            ("--set", !self.scene.overrides.is_empty()),
            ("--material", !self.scene.material.is_empty()),
            ("--force-step", self.scene.force_step),
        ];
        if self.scene.body.len() + usize::from(self.scene.file.is_some()) > 1 {
            return Err(Diagnostic::input(
                "--body",
                format!(
                    "there is no scene for it to go into: {} is none",
                    self.scene.place()
                ),
                "name a scene (.toml), or one body only",
            ));
        }
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(Diagnostic::input(
                *option,
                format!("it is for scenes, and {} is none", self.scene.place()),
                "name a scene (.toml), or leave the option out",
            )),
            None => Ok(()),
        }
    }
}

pub(super) fn run_scene(
    arguments: &RunArguments,
    threads: usize,
    interrupt: &Interrupt,
    tell: Tell<'_>,
) -> Result<()> {
    let (scene, bodies) = arguments.scene.read()?;
    let path = folder_to_open(arguments, &scene)?;
    let (scene, test, twice) = arranged(scene, &bodies, threads)?;
    let force_step = arguments.scene.force_step;
    let (mut prepared, setup) = plan_with_test(&scene, bodies, threads, force_step)
        .map_err(|error| arguments.scene.naming_set(error))?;
    prepared.inputs.set = arguments.scene.all_overrides();
    let inputs = prepared.inputs.clone();
    if !arguments.quiet {
        say_beforehand(&prepared, arguments.verbose);
    }
    let folder = open_folder(path, &scene)?;
    if let Some(folder) = folder.as_ref().filter(|_| !arguments.resume) {
        as_run::write_scene(folder, &arguments.scene, &scene)?;
    }
    let resume = match &folder {
        Some(folder) if arguments.resume => Some(checkpoint_of(folder)?),
        _ => None,
    };
    let shown = ShownProgress::new(arguments.quiet);
    let progress = |so_far: &SoFar| {
        shown.tell(so_far);
        tell(so_far.fraction, so_far);
    };
    let outcome = interrupt.run_interruptible(|interrupted| {
        let mut settings = RunSettings {
            folder: folder.as_ref(),
            resume,
            threads,
            interrupted,
            test,
            setup,
        };
        if let (Some((scene, bodies, test)), Some(own)) = (twice, &mut settings.test) {
            shown.begin("at twice the rate ");
            let (plan, setup) = plan_with_test(&scene, bodies, threads, force_step)?;
            let settings = RunSettings {
                folder: None,
                resume: None,
                threads,
                interrupted,
                test: Some(test),
                setup,
            };
            own.at_twice_the_rate =
                keep_awake(|| run_plan(plan, &scene, settings, &progress))?.test;
            shown.begin("");
        }
        if let Some(finished) = finish(&prepared, &scene, &settings)? {
            return Ok(Err(finished));
        }
        keep_awake(|| run_as_far_as_it_goes(prepared, &scene, settings, &progress)).map(Ok)
    });
    shown.end();
    let outcome = outcome.inspect_err(|problem| {
        let unfinished = Unfinished::new(&scene.source, inputs, problem);
        write_unfinished(&unfinished, problem, folder.as_ref(), arguments.scene.json);
    })?;
    // A scene that cannot be resumed must not replace that of the run.
    if let Some(folder) = folder.as_ref().filter(|_| arguments.resume) {
        as_run::write_scene(folder, &arguments.scene, &scene)?;
    }
    let is_whole = matches!(&outcome, Ok(outcome) if outcome.problem.is_none());
    if is_whole
        && arguments.keep == "tables"
        && let Some(folder) = &folder
    {
        folder.keep_tables()?;
    }
    match outcome {
        Ok(outcome) => say_outcome(arguments, outcome),
        Err(finished) => say_finished(arguments, &finished),
    }
}

/// Writes the summary of a run that a problem ended; bad input has not run anything. The user must
/// see the problem itself, whatever happens here.
fn write_unfinished(
    unfinished: &Unfinished,
    problem: &Diagnostic,
    folder: Option<&ResultsFolder>,
    as_json: bool,
) {
    if problem.kind == Kind::Input {
        return;
    }
    if let Some(folder) = folder {
        let _ = write_json(&folder.file(names::SUMMARY), unfinished);
    }
    if as_json {
        let _ = write_standard_json(unfinished);
    }
}

/// Folder of results, and the treatment of existing ones. None: no results are written.
fn folder_to_open(arguments: &RunArguments, scene: &Scene) -> Result<Option<(PathBuf, Existing)>> {
    if arguments.resume && scene.run.integrator == Integrator::Static {
        return Err(Diagnostic::input(
            "--resume",
            "run.integrator = \"static\" leaves no checkpoint to go on from",
            "leave it out; --force replaces the results that are in the folder",
        ));
    }
    let existing = match (arguments.force, arguments.resume) {
        (true, _) => Existing::Replace,
        (_, true) => Existing::Continue,
        _ => Existing::Refuse,
    };
    match results_path(arguments, scene) {
        Some(path) => Ok(Some((path, existing))),
        None if arguments.resume => Err(Diagnostic::input(
            "--resume",
            "no folder of results is named",
            "add --output FOLDER",
        )),
        None => Ok(None),
    }
}

/// Folder of results, if any: from the option, or from the scene, or the scene's name with `-out`.
fn results_path(arguments: &RunArguments, scene: &Scene) -> Option<PathBuf> {
    if let Some(out) = &arguments.output {
        return Some(out.clone());
    }
    let output = scene.output.as_ref()?;
    let stem = Path::new(&scene.source).file_stem().unwrap_or_default();
    let by_name = || PathBuf::from(format!("{}-out", stem.to_string_lossy()));
    Some(output.folder.clone().unwrap_or_else(by_name))
}

/// The run at twice the rate, which shows whether the rate matters.
type AtTwiceTheRate = (Scene, BTreeMap<String, Body>, TestSettings);

/// The scene of a laboratory test with its rate, and the same at twice the rate if that is to be
/// checked. Other scenes are unchanged.
fn arranged(
    scene: Scene,
    bodies: &BTreeMap<String, Body>,
    threads: usize,
) -> Result<(Scene, Option<TestSettings>, Option<AtTwiceTheRate>)> {
    let Some(body) = tested_body(&scene, bodies, threads)? else {
        return Ok((scene, None, None));
    };
    let test = TestSettings {
        lowest_frequency_hz: body.lowest_frequency_hz,
        at_twice_the_rate: None,
        wanted_n: None,
    };
    let checked = (scene.test.as_ref()).is_some_and(|test| test.rate_check);
    let twice = if checked && scene.run.integrator == Integrator::Leapfrog {
        let scene = arrange(&scene, &body, 2.0)?;
        Some((scene, bodies.clone(), test.clone()))
    } else {
        None
    };
    let scene = arrange(&scene, &body, 1.0)?;
    Ok((scene, Some(test), twice))
}

fn open_folder(path: Option<(PathBuf, Existing)>, scene: &Scene) -> Result<Option<ResultsFolder>> {
    let Some((path, existing)) = path else {
        return Ok(None);
    };
    refuse_inputs_among_results(&path, &scene.input_files())?;
    ResultsFolder::create(&path, existing).map(Some)
}

fn checkpoint_of(folder: &ResultsFolder) -> Result<Snapshot<'static>> {
    let path = folder.file(names::CHECKPOINT);
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    Snapshot::from_bytes(&read_checkpoint(&path)?).map_err(within)
}

/// Prints warnings before the run, and notes if everything is printed. A closed output is not a
/// reason to stop.
fn say_beforehand(plan: &Plan, with_notes: bool) {
    let notes = plan.notes.iter().filter(|_| with_notes);
    let notes = notes.map(|note| ("note", note));
    let warnings = plan.warnings.iter().chain(&plan.forecast.warnings);
    let warnings = warnings.map(|warning| ("warning", warning));
    for (kind, text) in notes.chain(warnings) {
        let word = format!("{kind}:");
        let word = match kind {
            "warning" => on_standard_error(&word, Colour::Yellow),
            _ => word,
        };
        let _ = writeln!(std::io::stderr(), "{word} {}", visible(text));
    }
}

/// Prints how a run ended, as text or as JSON.
fn say_outcome(arguments: &RunArguments, outcome: Outcome) -> Result<()> {
    let summary = &outcome.summary;
    if arguments.scene.json {
        write_standard_json(summary)?;
    } else if !arguments.quiet && (outcome.problem.is_none() || summary.ended_by == INTERRUPTION) {
        let mut text = match arguments.verbose {
            true => summary.to_string(),
            false => summary.short(),
        };
        // The error that follows says it.
        if let Some(problem) = &outcome.problem {
            let warning = format!("warning      {}\n", visible(&problem.to_string()));
            text = text.replace(&warning, "");
        }
        if summary.results.is_none() {
            text += "no files written: add --output FOLDER to keep the results\n";
        }
        let word = summary.verdict.word;
        write_standard_lines(&text, |line| colour_of(line, word))?;
    }
    outcome.problem.map_or(Ok(()), Err)
}

/// The colour of the first word of a line of the summary.
fn colour_of(line: &str, word: Trust) -> Option<Colour> {
    match line.split(' ').next() {
        Some("verdict") if word != Trust::Doubtful => Some(Colour::Green),
        Some("verdict" | "warning") => Some(Colour::Yellow),
        _ => None,
    }
}

/// Prints the missing files of a run that had reached its end.
fn say_finished(arguments: &RunArguments, finished: &Finished) -> Result<()> {
    if arguments.scene.json {
        return write_standard_output(|out| write_visible_json(out, &finished.summary));
    }
    if arguments.quiet {
        return Ok(());
    }
    write_standard_output(|out| {
        writeln!(
            out,
            "this run had come to its end; what was missing has been written: {}",
            visible(&finished.missing.join(", "))
        )
    })
}
