//! `dem-run export`: all frames of a run as one file for another program, or a scene for LAMMPS.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use dem_io::text::{counted, visible};
use dem_io::{Diagnostic, Result};
use dem_terminal::standard_output::{write_standard_json, write_standard_output};

use super::export_frames::{FramesArguments, export_frames};
use super::pool::in_pool;
use super::scene_arguments::SceneArguments;
use dem_lammps::refusals::refuse_parts;
use dem_rig::plan_with_test;

#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(super) struct ExportArguments {
    #[command(subcommand)]
    engine: Option<Engine>,
    #[command(flatten)]
    frames: Option<FramesArguments>,
}

/// Another program that runs a scene.
#[derive(Debug, Subcommand)]
enum Engine {
    /// Write a scene as data file and input script of LAMMPS, with a page of what is carried over
    #[command(
        mut_arg("file", |file| file.help("The scene (.toml)")),
        after_help = "First pack breakable bodies without overlap: dem-pack --overlap 0. What LAMMPS has no word for is refused, all at once, with what to do about it. Run the script where LAMMPS is, then read its dumps with dem-run import.\n\
                      Example:\n  dem-run export lammps data/scenes/cantilever.toml -o bar && cd bar && mpirun -np 4 lmp -in in.lammps"
    )]
    Lammps(LammpsArguments),
}

#[derive(Debug, Args)]
struct LammpsArguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The folder to write: new or empty
    #[arg(long, short, value_name = "FOLDER")]
    output: PathBuf,
    /// Only print errors; --json is still printed
    #[arg(long, short)]
    quiet: bool,
}

/// Writes frames or a scene.
pub(super) fn export(arguments: &ExportArguments) -> Result<()> {
    match (&arguments.engine, &arguments.frames) {
        (Some(Engine::Lammps(arguments)), _) => in_pool(arguments.scene.threads, |threads| {
            export_scene(arguments, threads)
        }),
        (None, Some(frames)) => export_frames(frames),
        (None, None) => Err(Diagnostic::input(
            "dem-run export",
            "no results are named, and no program",
            "write dem-run export RESULTS --to lammps-dump -o FILE, or dem-run export lammps SCENE -o FOLDER",
        )),
    }
}

/// Writes a scene for LAMMPS.
fn export_scene(arguments: &LammpsArguments, threads: usize) -> Result<()> {
    if !arguments.scene.names_a_scene() {
        return Err(Diagnostic::input(
            arguments.scene.place(),
            "this is not a scene (.toml)",
            "name a scene; dem-pack writes a body as LAMMPS data with -o FILE.data",
        ));
    }
    let (scene, bodies) = arguments.scene.read()?;
    let places = arguments.scene.places()?;
    let place_of = |key: &str| places.of(key);
    let refusals = refuse_parts(&scene);
    if scene.test.is_some() {
        // Its walls and supports are not in the scene: the plan would add refusals of them.
        refusals.check(&scene, &place_of)?;
    }
    let planned = plan_with_test(&scene, bodies, threads, arguments.scene.force_step);
    let (plan, _) = planned.or_else(|error| refusals.check(&scene, &place_of).and(Err(error)))?;
    let written = dem_lammps::export(&scene, &plan, refusals, &place_of, &arguments.output)?;
    if arguments.scene.json {
        return write_standard_json(&written);
    }
    if arguments.quiet {
        return Ok(());
    }
    write_standard_output(|out| {
        writeln!(
            out,
            "{}, {} of {}, {}, {} -> {}",
            counted(written.particles, "particle"),
            counted(written.bonds, "bond"),
            counted(written.bond_types, "type"),
            counted(written.clumps, "clump"),
            counted(written.steps as usize, "step"),
            visible(&arguments.output.display().to_string())
        )?;
        writeln!(out, "needs {}", written.needs)
    })
}
