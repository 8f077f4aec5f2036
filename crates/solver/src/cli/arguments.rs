//! The arguments of dem-run.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::{CommandFactory, Parser, Subcommand};
use dem_io::{Diagnostic, Result};
use dem_terminal::program::{Shell, parsed};

use super::calibrate::CalibrateArguments;
use super::export::ExportArguments;
use super::fragment::FragmentArguments;
use super::import::ImportArguments;
use super::keys::KeysArguments;
use super::lab::LabArguments;
use super::new::NewArguments;
use super::picture::PictureArguments;
use super::run_scene::RunArguments;
use super::scene_arguments::SceneArguments;
use super::stress::StressArguments;
use super::sweep::SweepArguments;

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
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) run: RunArguments,
}

impl Arguments {
    /// The arguments of a command line, the first of which is the name of the program. `dem-run run
    /// SCENE` is `dem-run SCENE`.
    pub fn parsed(given: impl Iterator<Item = OsString>) -> Result<Self> {
        let mut given: Vec<OsString> = given.collect();
        if given.len() > 2 && given[1] == "run" {
            given.remove(1);
        }
        refuse_no_command(&given)?;
        parsed("dem-run", &given).map_err(|error| naming_set(error, &given))
    }
}

/// The error, with the way to set a key of a scene if an unknown option has the name of one.
fn naming_set(error: Diagnostic, given: &[OsString]) -> Diagnostic {
    let options = given.iter().filter_map(|argument| argument.to_str());
    let unknown = options
        .filter(|option| {
            error
                .problem
                .contains(&format!("unexpected argument '{option}'"))
        })
        .filter_map(|option| option.strip_prefix("--"));
    let keys = unknown.map(|name| name.replace('-', "_"));
    let mut settings = keys.filter_map(|key| Some((dem_scene::reference::table_of(&key)?, key)));
    match settings.next() {
        Some((table, key)) => Diagnostic {
            remedy: format!("it is a value of the scene: --set {table}.{key}=VALUE"),
            ..error
        },
        None => error,
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
pub(super) enum Command {
    /// Dry run: print the time step and why, active stages, memory and the estimated run time
    Check {
        #[command(flatten)]
        scene: SceneArguments,
        /// Write a picture of the start to this file (.png)
        #[arg(long, value_name = "FILE")]
        picture: Option<PathBuf>,
        /// Print everything: all values of the scene, masses, estimates of the time step, stages,
        /// notes
        #[arg(long, short, conflicts_with_all = ["json", "quiet"])]
        verbose: bool,
        /// Only print errors; --json is still printed
        #[arg(long, short)]
        quiet: bool,
    },
    /// Make a folder with a scene to start from: drop, drop-weight, chute, crusher, cone, mill,
    /// screen, silo, bending, brazilian or compression
    #[command(
        after_help = "Makes FOLDER with scene.toml, shape.stl, body.vtp (the shape packed with spheres) and scene.schema.json for editors.\n\
                      On a terminal it asks what the options leave open, and Enter takes the default; elsewhere defaults are taken.\n\
                      Nothing is overwritten.\n\
                      Examples:\n  dem-run new drop my-drop\n  \
                      dem-run new drop my-drop --shape tablet.stl --size \"12 mm\" --mass \"420 mg\" --height \"1 m\""
    )]
    New(NewArguments),
    /// Print the keys of scenes and studies: type, unit, default, limits and meaning
    #[command(
        after_help = "Examples:\n  dem-run keys bodies\n  dem-run keys drop\n  dem-run keys study"
    )]
    Keys(KeysArguments),
    /// Write a fragment of a run as a body: its particles as they stand in a frame, and its
    /// unbroken bonds
    #[command(
        after_help = "Bonds keep their stress-free lengths: a stretched bond stays stretched. A .vtp keeps how bonds are bent, twisted and sheared \
                      as well; other formats are refused for such bonds. Velocities are not kept.\n\
                      Examples:\n  dem-run fragment results --largest -o piece.vtp\n  \
                      dem-run fragment results --all --stl -o hulls"
    )]
    Fragment(FragmentArguments),
    /// Write all frames of a run as one file for another program, or a scene for LAMMPS
    #[command(
        after_help = "A LAMMPS dump opens in OVITO: particles with id, type (named after the body), radius, position, velocity and fragment; with --bonds, the unbroken bonds \
                      as a dump of local data; with --walls, the walls as STL.\n\
                      Example:\n  dem-run export results --to lammps-dump -o frames.dump --bonds bonds.dump --walls walls\n  \
                       dem-run export lammps data/scenes/cantilever.toml -o bar"
    )]
    Export(ExportArguments),
    /// Read what LAMMPS computed from an exported scene, as results of a run: frames and page
    #[command(after_help = "Example:\n  dem-run import bar -o bar-results")]
    Import(ImportArguments),
    /// Evaluate laboratory tests: force-displacement curves to modulus, strength and mean curve,
    /// sheets of drop-weight tests to the law by which an ore breaks
    #[command(
        after_help = "Finds in each curve the offset of the load cell, the seating and the linear part; leaves out specimens in doubt, and says why.\n\
                      Of drop-weight tests it fits A, b, the fracture energy, the exponents of size and that of the family, with confidence intervals.\n\
                      Examples:\n  \
                      dem-run lab a.csv b.csv c.csv --type four-point-bending --support-span 180mm --loading-span 80mm --width 30mm --height 35mm\n  \
                      dem-run lab sheet.csv --type drop-weight --material ore --output ore.toml"
    )]
    Lab(Box<LabArguments>),
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
    Calibrate(Box<CalibrateArguments>),
    /// Write a picture or a film of a finished run, from any side
    #[command(after_help = "Examples:\n  \
                      dem-run picture chute-out -o impact.png --frame 40 --from 1,-2,0.5 --zoom 3 --colour-by speed\n  \
                      dem-run picture chute-out -o chute.gif --size 640x360")]
    Picture(PictureArguments),
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
    Sweep(SweepArguments),
    /// Stress suite: run stiff and extreme scenes, each with a prediction made before its run;
    /// print case, predicted, observed, verdict
    #[command(after_help = "Exit code 0 if all cases behave as predicted, else 1.\n\
                      Example:\n  dem-run stress spin mass-ratio")]
    Stress(StressArguments),
    /// Print a script that completes dem-run's options in a shell
    Completions {
        /// Which shell
        shell: Shell,
    },
    /// Print the man page
    Man,
}
