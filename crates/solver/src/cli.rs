//! The command line of dem-run: its arguments and their execution.

mod all_fragments;
mod as_run;
mod calibrate;
mod check;
mod export;
mod fragment;
mod import;
mod keys;
mod lab;
mod new;
mod packings;
mod picture;
mod progress;
mod statics;
mod stress;
mod sweep;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::{Args, CommandFactory, Parser, Subcommand};
use dem_io::body::{body_summary, read_body};
use dem_io::colour::{Colour, on_standard_error};
use dem_io::diagnostic::Kind;
use dem_io::program::{
    Shell, parsed, print_completions, print_man_page, take_size_limits_as_errors,
};
use dem_io::safe_write::{
    remove_unfinished, write_file, write_standard_error, write_standard_json, write_standard_lines,
    write_standard_output, write_visible_json,
};
use dem_io::text::visible;
use dem_io::{Body, Diagnostic, Result, read_input};
use dem_report::report;
use dem_results::checkpoint::read_checkpoint;
use dem_results::folder::refuse_inputs_among_results;
use dem_results::{Existing, ResultsFolder, write_json};
use dem_scene::read_scene;
use dem_scene::{BodySource, Integrator, Scene, include_text, read_bodies};

use self::progress::ShownProgress;
use crate::interrupt::Interrupt;
use crate::laboratory::arrange::{arrange, lowest_in_test_hz};
use crate::laboratory::watch::TestSettings;
use crate::output::summary::Unfinished;
use crate::plan::{Plan, plan};
use crate::run::snapshot::Snapshot;
use crate::run::{
    Finished, Outcome, RunSettings, SoFar, finish, run as run_plan, run_as_far_as_it_goes,
};

/// Options that had another name before version 0.1, and their new names.
pub const RENAMED: [(&str, &str); 3] = [
    ("--out", "--output"),
    ("--want", "--max-error"),
    ("--colour", "--colour-by"),
];

/// Simulates the breakage of bonded particles with the discrete element method.
#[derive(Debug, Parser)]
#[command(
    version,
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 done, 1 failed while running, 2 bad input, 3 unstable, 130 interrupted.\n\
                  Examples:\n  \
                  dem-run new drop my-drop\n  \
                  dem-run data/scenes/cantilever.toml\n  \
                  dem-run spinning-bar.toml --set run.end_time=0.5 --output spin\n  \
                  dem-pack cake.stl --diameter 2mm..3mm | dem-run clamped.toml --body -"
)]
pub struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    run: RunArguments,
}

impl Arguments {
    /// The arguments of a command line, the first of which is the name of the program. `dem-run run
    /// SCENE` is `dem-run SCENE`.
    ///
    /// # Errors
    /// An unknown command or option, or one that has been renamed (exit code 2).
    pub fn parsed(given: impl Iterator<Item = OsString>) -> Result<Self> {
        let mut given: Vec<OsString> = given.collect();
        if given.len() > 2 && given[1] == "run" {
            given.remove(1);
        }
        refuse_no_command(&given)?;
        parsed("dem-run", &given, &RENAMED)
    }
}

/// Refuses a first argument that is a word, but neither a command nor a file.
fn refuse_no_command(given: &[OsString]) -> Result<()> {
    let Some(first) = given.get(1).and_then(|first| first.to_str()) else {
        return Ok(());
    };
    let command = Arguments::command();
    let known: Vec<&str> = command
        .get_subcommands()
        .map(clap::Command::get_name)
        .collect();
    let is_word = first.starts_with(char::is_alphanumeric)
        && first.chars().all(|c| c.is_alphanumeric() || c == '-');
    if !is_word || first == "help" || known.contains(&first) || Path::new(first).exists() {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("dem-run {first}"),
        "there is no such command, and no such file",
        format!(
            "name a scene (.toml), or one of the commands {}",
            known.join(", ")
        ),
    ))
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Dry run: print the time step and why, active stages, memory and the estimated run time
    Check {
        #[command(flatten)]
        scene: SceneArguments,
        /// Write a picture of the start to this file (.png)
        #[arg(long, value_name = "FILE")]
        picture: Option<PathBuf>,
        /// Only print errors; --json is still printed
        #[arg(long, short)]
        quiet: bool,
    },
    /// Make a folder with a scene to start from: drop, chute, crusher, bending or compression
    #[command(
        after_help = "Makes FOLDER with scene.toml, shape.stl, body.vtp (few large spheres, to run in seconds) and scene.schema.json for editors.\n\
                      Nothing is overwritten.\n\
                      Example:\n  dem-run new drop my-drop"
    )]
    New(new::NewArguments),
    /// Print the keys of scenes and studies: type, unit, default, limits and meaning
    #[command(after_help = "Examples:\n  dem-run keys bodies\n  dem-run keys study")]
    Keys(keys::KeysArguments),
    /// Write a fragment of a run as a body: its particles as they stand in a frame, and its
    /// unbroken bonds
    #[command(
        after_help = "Bonds keep their stress-free lengths: a stretched bond stays stretched. Velocities, and bending, torsion and shear of bonds, \
                      are not kept.\n\
                      Examples:\n  dem-run fragment results --largest -o piece.vtp\n  \
                      dem-run fragment results --all --stl -o hulls"
    )]
    Fragment(fragment::FragmentArguments),
    /// Write all frames of a run as one file for another program, or a scene for LAMMPS
    #[command(
        after_help = "A LAMMPS dump opens in OVITO: particles with id, type (the body), radius, position, velocity and fragment; with --bonds, the unbroken bonds \
                      as a dump of local data.\n\
                      Example:\n  dem-run export results --to lammps-dump -o frames.dump --bonds bonds.dump\n  \
                      dem-run export lammps data/scenes/cantilever.toml -o bar"
    )]
    Export(export::ExportArguments),
    /// Read what LAMMPS computed from an exported scene, as results of a run: frames and page
    #[command(after_help = "Example:\n  dem-run import bar -o bar-results")]
    Import(import::ImportArguments),
    /// Evaluate measured force-displacement curves: modulus, strength, mean curve
    #[command(
        after_help = "Finds in each curve the offset of the load cell, the seating and the linear part; leaves out specimens in doubt, and says why.\n\
                      Example:\n  \
                      dem-run lab a.csv b.csv c.csv --type four-point-bending --support-span 180mm --loading-span 80mm --width 30mm --height 35mm"
    )]
    Lab(Box<lab::LabArguments>),
    /// Find modulus and strength of bonds with which the mean test of several packings gives the
    /// wanted modulus and strength of the body
    #[command(
        after_help = "The scene has a [test] with young_modulus, strength or measured, the targets. Its bonds hold the first guess.\n\
                      Exit code 1 if a target is not met; the page says why.\n\
                      Examples:\n  \
                      dem-run calibrate bending.toml --set test.measured=measured.json -o cake.toml -- sample.stl --diameter 4mm..6mm --overlap 0.296 --bond-range 1.0\n  \
                      dem-run calibrate bending.toml --body a.vtp --body b.vtp --free strength\n  \
                      dem-run calibrate drop.toml --free bonds.cake.damping.damping_ratio=rebound:0.4"
    )]
    Calibrate(Box<calibrate::CalibrateArguments>),
    /// Write a picture or a film of a finished run, from any side
    #[command(after_help = "Examples:\n  \
                      dem-run picture chute-out -o impact.png --frame 40 --from 1,-2,0.5 --zoom 3 --colour-by speed\n  \
                      dem-run picture chute-out -o chute.gif --size 640x360")]
    Picture(picture::PictureArguments),
    /// Write the page of a finished run again: verdict, view in three dimensions, results, curves
    Report {
        /// The folder of the run
        folder: PathBuf,
    },
    /// Parameter study: run a scene with many settings, and compare error and run time
    #[command(
        after_help = "A study names a scene, what varies, what is measured and what it is compared with. Every run is a separate process.\n\
                      Exit code 1, after the tables are written, where runs failed or are missing; also with --collect and --quiet.\n\
                      Examples:\n  \
                      dem-run sweep data/studies/cantilever-models.toml --max-error all=1% --write fast.toml\n  \
                      dem-run sweep study.toml --list | parallel -j 16; dem-run sweep study.toml --collect"
    )]
    Sweep(sweep::SweepArguments),
    /// Stress suite: run stiff and extreme scenes, each with a prediction made before its run;
    /// print case, predicted, observed, verdict
    #[command(after_help = "Exit code 0 if all cases behave as predicted, else 1.\n\
                      Example:\n  dem-run stress spin mass-ratio")]
    Stress(stress::StressArguments),
    /// Print a script that completes dem-run's options in a shell
    Completions {
        /// Which shell
        shell: Shell,
    },
    /// Print the man page
    Man,
}

#[derive(Debug, Args)]
struct SceneArguments {
    /// The scene (.toml); or a body (.vtp, .data, .csv, .txt) to describe
    #[arg(value_name = "SCENE", required_unless_present = "body")]
    file: Option<PathBuf>,
    /// File of a body, instead of the scene's; - is a .vtp on standard input. NAME= may be left
    /// out if there is only one body
    #[arg(long, value_name = "[NAME=]FILE")]
    body: Vec<String>,
    /// File of materials, contacts and bonds, as dem-run calibrate writes it: its tables replace
    /// those of the scene
    #[arg(long, value_name = "FILE")]
    material: Vec<PathBuf>,
    /// Set a value of the scene, such as run.end_time=0.5 or "bonds.bar.young_modulus=20 MPa"
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Accept a time step of the scene above the largest stable one
    #[arg(long)]
    force_step: bool,
    /// Number of threads; all cores unless given. The results are the same for any number
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Print it as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
struct RunArguments {
    #[command(flatten)]
    scene: SceneArguments,
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
    /// Only print errors: no progress, no warnings, no summary; --json is still printed
    #[arg(long, short)]
    quiet: bool,
}

/// The program: does what its command line says, reports an error on standard error, and returns
/// the exit code. The first of `given` is the name of the program. At Ctrl-C a run stops and keeps
/// its state; anything else, or a second Ctrl-C, ends the process.
pub fn program(given: impl Iterator<Item = OsString>) -> u8 {
    let interrupt = Arc::new(Interrupt::default());
    let asked = Arc::clone(&interrupt);
    let at_interrupt = move || {
        if !asked.ask() {
            remove_unfinished();
            let problem = Diagnostic::interrupted("interrupted", "");
            write_standard_error(&problem);
            std::process::exit(i32::from(problem.exit_code()));
        }
    };
    let done = Arguments::parsed(given).and_then(|arguments| {
        take_size_limits_as_errors();
        // Without the handler, the only loss is the checkpoint of an interrupted run.
        let _ = ctrlc::set_handler(at_interrupt);
        run(&arguments, &interrupt, &|_| {})
    });
    match done {
        Ok(()) => 0,
        Err(error) => {
            write_standard_error(&error);
            error.exit_code()
        }
    }
}

/// Does what was requested. `interrupt` tells a run to stop; `tell` is called from time to time with
/// how far the run of a scene has come.
///
/// # Errors
/// Bad input, a run that fails or goes unstable, or standard output that cannot be written to. It
/// is not an error if a reader closes standard output early.
pub fn run(
    arguments: &Arguments,
    interrupt: &Interrupt,
    tell: &(dyn Fn(&SoFar) + Sync),
) -> Result<()> {
    match &arguments.command {
        Some(Command::Check { scene, .. }) if !scene.names_a_scene() => Err(Diagnostic::input(
            scene.place(),
            "this is not a scene (.toml)",
            "name a scene; dem-run describes a body without check",
        )),
        Some(Command::Check {
            scene,
            picture,
            quiet,
        }) => in_pool(scene.threads, |threads| {
            let (scene_data, bodies) = scene.read()?;
            let scene_data = match lowest_in_test_hz(&scene_data, &bodies, threads)? {
                Some(lowest_hz) => arrange(&scene_data, lowest_hz, 1.0)?,
                None => scene_data,
            };
            let mut plan = plan(&scene_data, bodies, threads, scene.force_step)?;
            plan.inputs.set = scene.all_overrides();
            if let Some(file) = picture {
                check::write_picture(&scene_data, &plan, file)?;
            }
            if *quiet && !scene.json {
                return Ok(());
            }
            check::check(&scene_data, &plan, scene.json)
        }),
        Some(Command::New(arguments)) => new::new(arguments),
        Some(Command::Keys(arguments)) => keys::keys(arguments),
        Some(Command::Fragment(arguments)) => fragment::fragment(arguments),
        Some(Command::Export(arguments)) => export::export(arguments),
        Some(Command::Import(arguments)) => import::import(arguments),
        Some(Command::Lab(arguments)) => lab::lab(arguments),
        Some(Command::Calibrate(arguments)) => calibrate::calibrate(arguments, interrupt),
        Some(Command::Picture(arguments)) => in_pool(None, |_| picture::write_picture(arguments)),
        Some(Command::Report { folder }) => write_report(folder),
        Some(Command::Sweep(arguments)) => sweep::sweep(arguments, interrupt),
        Some(Command::Stress(arguments)) => stress::stress(arguments, interrupt),
        Some(Command::Completions { shell }) => print_completions(*shell, Arguments::command()),
        Some(Command::Man) => print_man_page(Arguments::command()),
        None if arguments.run.scene.names_a_scene() => {
            in_pool(arguments.run.scene.threads, |threads| {
                run_scene(&arguments.run, threads, interrupt, tell)
            })
        }
        None => {
            arguments.run.refuse_scene_options()?;
            body_information(&arguments.run.scene)
        }
    }
}

/// Writes `report.html` of a finished run.
fn write_report(folder: &Path) -> Result<()> {
    let summary = folder.join("summary.json");
    let summary = read_input(&summary, "the summary of a run")?;
    let page = report(folder, &String::from_utf8_lossy(&summary))?;
    let target = folder.join("report.html");
    write_file(&target, |out| out.write_all(page.as_bytes()))?;
    write_standard_output(|out| writeln!(out, "{}", visible(&target.display().to_string())))
}

fn in_pool(wanted: Option<usize>, work: impl FnOnce(usize) -> Result<()> + Send) -> Result<()> {
    if let Some(threads @ (0 | 1025..)) = wanted {
        return Err(Diagnostic::input(
            "--threads",
            format!("{threads} is not between 1 and 1024"),
            "leave it out for all cores",
        ));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(wanted.unwrap_or(0))
        .build()
        .map_err(|error| {
            Diagnostic::failed(
                "--threads",
                format!("the threads cannot be started: {error}"),
                "ask for fewer",
            )
        })?;
    let threads = pool.current_num_threads();
    pool.install(|| work(threads))
}

impl RunArguments {
    /// Refuses options that have no meaning if no scene is run.
    fn refuse_scene_options(&self) -> Result<()> {
        let given = [
            ("--output", self.output.is_some()),
            ("--force", self.force),
            ("--resume", self.resume),
            ("--keep", self.keep != "all"),
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

impl SceneArguments {
    /// Human-readable name of the input.
    fn place(&self) -> String {
        let named = self.file.as_ref().map(|path| path.display().to_string());
        named.unwrap_or_else(|| "--body without a scene".to_owned())
    }

    fn names_a_scene(&self) -> bool {
        let is_scene = |path: &PathBuf| path.extension().is_some_and(|e| e == "toml");
        self.file.as_ref().is_some_and(is_scene)
    }

    /// The `--set` values, and `--material` as one.
    fn all_overrides(&self) -> Vec<String> {
        let mut overrides = self.overrides.clone();
        if !self.material.is_empty() {
            let names = self.material.iter().map(|path| path.display().to_string());
            overrides.push(include_text(&names.collect::<Vec<String>>()));
        }
        overrides
    }

    /// The scene and all its bodies.
    fn read(&self) -> Result<(Scene, BTreeMap<String, Body>)> {
        let file = self.file.as_deref().unwrap_or(Path::new(""));
        let mut scene = read_scene(file, &self.all_overrides())?;
        let mut named: BTreeMap<String, &str> = BTreeMap::new();
        for option in &self.body {
            let name = set_body(&mut scene, option)?;
            if let Some(other) = named.insert(name.clone(), option) {
                return Err(Diagnostic::input(
                    format!("--body {option}"),
                    format!("the body '{name}' has its file from --body {other} already"),
                    "name one file for each body",
                ));
            }
        }
        refuse_two_pipes(&scene)?;
        let bodies = read_bodies(&scene)?;
        Ok((scene, bodies))
    }
}

/// Sets a body's file from an option `[NAME=]FILE`. Returns the body's name.
fn set_body(scene: &mut Scene, option: &str) -> Result<String> {
    let only = (scene.bodies.len() == 1).then(|| scene.bodies.keys().next());
    let (name, file) = named_body(scene, option, only.flatten().map(String::as_str))?;
    if let Some(entry) = scene.bodies.get_mut(&name) {
        entry.source = BodySource::File(file);
    }
    Ok(name)
}

/// Body and file of an option `[NAME=]FILE`; `usual`: the body that is meant without a name.
fn named_body(scene: &Scene, option: &str, usual: Option<&str>) -> Result<(String, PathBuf)> {
    let (name, file) = match option.split_once('=') {
        Some((name, file)) => (Some(name), file),
        None => (usual, option),
    };
    let place = || format!("--body {option}");
    let names: Vec<&str> = scene.bodies.keys().map(String::as_str).collect();
    let (problem, remedy) = match name {
        _ if file.is_empty() => (
            "no file is named".to_owned(),
            "write --body FILE, or --body NAME=FILE".to_owned(),
        ),
        Some(name) if names.contains(&name) => {
            return Ok((name.to_owned(), PathBuf::from(file)));
        }
        Some(name) => (
            format!("the scene has no body '{name}'"),
            format!("use one of {}", names.join(", ")),
        ),
        None => (
            format!("the scene has {} bodies", names.len()),
            format!(
                "say which: --body NAME={file} with one of {}",
                names.join(", ")
            ),
        ),
    };
    Err(Diagnostic::input(place(), problem, remedy))
}

fn refuse_two_pipes(scene: &Scene) -> Result<()> {
    let is_piped =
        |source: &BodySource| matches!(source, BodySource::File(path) if path == Path::new("-"));
    let mut piped = scene
        .bodies
        .iter()
        .filter(|(_, entry)| is_piped(&entry.source));
    if let (Some(_), Some((name, _))) = (piped.next(), piped.next()) {
        return Err(Diagnostic::input(
            format!("{}: [bodies.{name}]", scene.source),
            "standard input can be read for one body only",
            "write the others to files",
        ));
    }
    Ok(())
}

fn run_scene(
    arguments: &RunArguments,
    threads: usize,
    interrupt: &Interrupt,
    tell: &dyn Fn(&SoFar),
) -> Result<()> {
    let (scene, bodies) = arguments.scene.read()?;
    let path = folder_to_open(arguments, &scene)?;
    let (scene, test, twice) = arranged(scene, &bodies, threads)?;
    let force_step = arguments.scene.force_step;
    let mut prepared = plan(&scene, bodies, threads, force_step)?;
    prepared.inputs.set = arguments.scene.all_overrides();
    let inputs = prepared.inputs.clone();
    if !arguments.quiet {
        say_beforehand(&prepared);
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
        tell(so_far);
    };
    let outcome = interrupt.run_interruptible(|interrupted| {
        let mut settings = RunSettings {
            folder: folder.as_ref(),
            resume,
            threads,
            interrupted,
            test,
        };
        if let (Some((scene, bodies, test)), Some(own)) = (twice, &mut settings.test) {
            shown.begin("at twice the rate ");
            let plan = plan(&scene, bodies, threads, force_step)?;
            let settings = RunSettings {
                folder: None,
                resume: None,
                threads,
                interrupted,
                test: Some(test),
            };
            own.at_twice_the_rate = run_plan(plan, &scene, settings, &progress)?.test;
            shown.begin("");
        }
        if let Some(finished) = finish(&prepared, &scene, &settings)? {
            return Ok(Err(finished));
        }
        run_as_far_as_it_goes(prepared, &scene, settings, &progress).map(Ok)
    });
    shown.end();
    let outcome = outcome.inspect_err(|problem| {
        let unfinished = Unfinished::new(&scene.source, inputs, problem);
        // The user must see the problem itself, whatever happens here. Bad input has not run
        // anything.
        if problem.kind != Kind::Input {
            let _ = folder
                .as_ref()
                .map(|folder| write_json(&folder.summary(), &unfinished));
            if arguments.scene.json {
                let _ = write_standard_json(&unfinished);
            }
        }
    })?;
    // A scene that cannot be resumed must not replace that of the run.
    if let Some(folder) = folder.as_ref().filter(|_| arguments.resume) {
        as_run::write_scene(folder, &arguments.scene, &scene)?;
    }
    let is_whole = outcome
        .as_ref()
        .is_ok_and(|outcome| outcome.problem.is_none());
    if let Some(folder) = folder
        .as_ref()
        .filter(|_| is_whole && arguments.keep == "tables")
    {
        folder.keep_tables()?;
    }
    match outcome {
        Ok(outcome) => say_outcome(arguments, outcome),
        Err(finished) => say_finished(arguments, &finished),
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

/// The run at twice the rate, which shows whether the rate matters.
type AtTwiceTheRate = (Scene, BTreeMap<String, Body>, TestSettings);

/// The scene of a laboratory test with its rate, and the same at twice the rate if that is to be
/// checked. Other scenes are unchanged.
fn arranged(
    scene: Scene,
    bodies: &BTreeMap<String, Body>,
    threads: usize,
) -> Result<(Scene, Option<TestSettings>, Option<AtTwiceTheRate>)> {
    let Some(lowest_frequency_hz) = lowest_in_test_hz(&scene, bodies, threads)? else {
        return Ok((scene, None, None));
    };
    let test = TestSettings {
        lowest_frequency_hz,
        at_twice_the_rate: None,
    };
    let checked = (scene.test.as_ref()).is_some_and(|test| test.rate_check);
    let twice = if checked && scene.run.integrator == Integrator::Leapfrog {
        let scene = arrange(&scene, lowest_frequency_hz, 2.0)?;
        Some((scene, bodies.clone(), test.clone()))
    } else {
        None
    };
    let scene = arrange(&scene, lowest_frequency_hz, 1.0)?;
    Ok((scene, Some(test), twice))
}

/// Prints notes and warnings before the run. A closed output is not a reason to stop.
fn say_beforehand(plan: &Plan) {
    let notes = plan.notes.iter().map(|note| ("note", note));
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

fn open_folder(path: Option<(PathBuf, Existing)>, scene: &Scene) -> Result<Option<ResultsFolder>> {
    let Some((path, existing)) = path else {
        return Ok(None);
    };
    refuse_inputs_among_results(&path, &scene.input_files())?;
    ResultsFolder::create(&path, existing).map(Some)
}

fn checkpoint_of(folder: &ResultsFolder) -> Result<Snapshot<'static>> {
    let path = folder.checkpoint();
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    Snapshot::from_bytes(&read_checkpoint(&path)?).map_err(within)
}

/// Prints how a run ended, as text or as JSON.
fn say_outcome(arguments: &RunArguments, outcome: Outcome) -> Result<()> {
    let summary = &outcome.summary;
    if arguments.scene.json {
        write_standard_json(summary)?;
    } else if !arguments.quiet && outcome.problem.is_none() {
        let mut text = summary.to_string();
        if summary.results.is_none() {
            text += "no files written: add --output FOLDER to keep the results\n";
        }
        let is_sound = summary.verdict.sound;
        write_standard_lines(&text, |line| colour_of(line, is_sound))?;
    }
    outcome.problem.map_or(Ok(()), Err)
}

/// The colour of the first word of a line of the summary.
fn colour_of(line: &str, is_sound: bool) -> Option<Colour> {
    match line.split(' ').next() {
        Some("verdict") if is_sound => Some(Colour::Green),
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

fn body_information(arguments: &SceneArguments) -> Result<()> {
    let given = arguments.body.first().map(PathBuf::from);
    let path = arguments.file.as_ref().or(given.as_ref());
    let path = path.ok_or_else(|| {
        Diagnostic::input(
            "",
            "no scene and no body was given",
            "name a scene (.toml) or a body, or - for a body on standard input",
        )
    })?;
    let summary = body_summary(&read_body(path)?);
    if arguments.json {
        return write_standard_json(&summary);
    }
    write_standard_output(|out| write!(out, "{summary}"))
}
