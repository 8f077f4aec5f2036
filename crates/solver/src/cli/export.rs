//! `dem-run export`: all frames of a run as one file for another program, or a scene for LAMMPS.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use dem_io::body::{StoredParticles, read_particles};
use dem_io::safe_write::PendingFile;
use dem_io::standard_output::{write_standard_json, write_standard_output};
use dem_io::text::visible;
use dem_io::vtk::exact;
use dem_io::write_target::need_folder_of;
use dem_io::{Bounds, Diagnostic, Result};
use dem_results::folder::{frame_in, frames_in};

use super::fragment::refuse_overwriting_files;
use super::pool::in_pool;
use super::scene_arguments::SceneArguments;
use crate::lammps::{self, refusals::refuse_parts};
use crate::plan::plan;

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
        after_help = "What LAMMPS has no word for is refused by name. Run the script where LAMMPS is, then read its dumps with dem-run import.\n\
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

#[derive(Debug, Args)]
struct FramesArguments {
    /// The folder of results of a run
    results: PathBuf,
    /// Format of the file
    #[arg(long, value_enum)]
    to: Format,
    /// The file to write
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Write the unbroken bonds to this file as well, as a LAMMPS dump of local data
    #[arg(long, value_name = "FILE")]
    bonds: Option<PathBuf>,
    /// Only print warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

/// The format of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// LAMMPS dump with one section for each frame, as OVITO reads it
    LammpsDump,
}

/// Writes frames or a scene.
///
/// # Errors
/// Those of the two.
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
    refuse_parts(&scene)?;
    let plan = plan(&scene, bodies, threads, arguments.scene.force_step)?;
    let written = lammps::export(&scene, &plan, &arguments.output)?;
    if arguments.scene.json {
        return write_standard_json(&written);
    }
    if arguments.quiet {
        return Ok(());
    }
    write_standard_output(|out| {
        writeln!(
            out,
            "{} particles, {} bonds of {} types, {} clumps, {} steps -> {}",
            written.particles,
            written.bonds,
            written.bond_types,
            written.clumps,
            written.steps,
            visible(&arguments.output.display().to_string())
        )
    })
}

/// Writes all frames.
///
/// # Errors
/// The folder has no frames; a frame is damaged; a file cannot be written.
fn export_frames(arguments: &FramesArguments) -> Result<()> {
    let Format::LammpsDump = arguments.to;
    let results = &arguments.results;
    let targets: Vec<PathBuf> = std::iter::once(&arguments.output)
        .chain(&arguments.bonds)
        .cloned()
        .collect();
    if targets.len() == 2 && targets[0] == targets[1] {
        return Err(Diagnostic::input(
            "--bonds",
            "particles and bonds have the same file",
            "name two files",
        ));
    }
    targets.iter().try_for_each(|file| need_folder_of(file))?;
    refuse_overwriting_files(results, &targets)?;
    let numbers = frames_in(results)?;
    if numbers.is_empty() {
        return Err(Diagnostic::input(
            results.display().to_string(),
            "there are no frames in this folder",
            "name the folder of results of a run",
        ));
    }
    let particles = write_dump(results, &numbers, &arguments.output, particle_section)?;
    let bonds = arguments.bonds.as_ref();
    let bonds = bonds.map(|path| write_dump(results, &numbers, path, bond_section));
    let bonds = bonds.transpose()?;
    particles.publish()?;
    bonds.map_or(Ok(()), PendingFile::publish)?;
    if arguments.quiet {
        return Ok(());
    }
    write_standard_output(|out| {
        let s = if numbers.len() == 1 { "" } else { "s" };
        let files: Vec<String> = targets
            .iter()
            .map(|file| visible(&file.display().to_string()).to_string())
            .collect();
        writeln!(out, "{} frame{s} -> {}", numbers.len(), files.join(", "))
    })
}

/// Writes a section for each frame.
fn write_dump(
    results: &Path,
    numbers: &[usize],
    output: &Path,
    section: fn(&StoredParticles, usize, &mut dyn Write) -> io::Result<()>,
) -> Result<PendingFile> {
    let mut problem = None;
    let written = PendingFile::write(output, |out| {
        // Once, as LAMMPS does: OVITO finds no further frame otherwise.
        writeln!(out, "ITEM: UNITS\nsi")?;
        for &number in numbers {
            match read_particles(&frame_in(results, number)) {
                Ok(frame) => section(&frame, number, out)?,
                Err(error) => {
                    problem = Some(error);
                    return Err(io::Error::other("a frame cannot be read"));
                }
            }
        }
        Ok(())
    });
    match problem {
        Some(error) => Err(error),
        None => written,
    }
}

/// The head of a section: its time and number.
fn head(frame: &StoredParticles, number: usize, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "ITEM: TIME\n{}", exact(frame.time_s))?;
    writeln!(out, "ITEM: TIMESTEP\n{number}")
}

/// The box around all particles.
fn box_bounds(frame: &StoredParticles, out: &mut dyn Write) -> io::Result<()> {
    let corners = frame.positions.iter().zip(&frame.radii);
    let corners = corners.flat_map(|(place, r)| [place.map(|x| x - r), place.map(|x| x + r)]);
    let bounds = Bounds::of(corners);
    writeln!(out, "ITEM: BOX BOUNDS ff ff ff")?;
    for k in 0..3 {
        let [low, high] = if frame.positions.is_empty() {
            [0.0, 1.0]
        } else {
            [bounds.low[k], bounds.high[k]]
        };
        writeln!(out, "{} {}", exact(low), exact(high))?;
    }
    Ok(())
}

/// The particles of a frame. LAMMPS counts ids and types from 1.
fn particle_section(frame: &StoredParticles, number: usize, out: &mut dyn Write) -> io::Result<()> {
    head(frame, number, out)?;
    writeln!(out, "ITEM: NUMBER OF ATOMS\n{}", frame.positions.len())?;
    box_bounds(frame, out)?;
    let fragments = frame.fragments.as_ref();
    let last = if fragments.is_some() {
        " fragment_id"
    } else {
        ""
    };
    writeln!(out, "ITEM: ATOMS id type radius x y z vx vy vz body{last}")?;
    for i in 0..frame.positions.len() {
        let body = frame.bodies[i];
        write!(
            out,
            "{} {} {}",
            frame.ids[i] + 1,
            body + 1,
            exact(frame.radii[i])
        )?;
        for number in frame.positions[i].iter().chain(&frame.velocities_m_s[i]) {
            write!(out, " {}", exact(*number))?;
        }
        match fragments {
            Some(fragments) => writeln!(out, " {body} {}", fragments[i])?,
            None => writeln!(out, " {body}")?,
        }
    }
    Ok(())
}

/// The unbroken bonds of a frame, by the ids of their particles.
fn bond_section(frame: &StoredParticles, number: usize, out: &mut dyn Write) -> io::Result<()> {
    head(frame, number, out)?;
    let whole = || {
        frame
            .bonds
            .iter()
            .zip(&frame.broken)
            .filter(|(_, broken)| !**broken)
    };
    writeln!(out, "ITEM: NUMBER OF ENTRIES\n{}", whole().count())?;
    box_bounds(frame, out)?;
    writeln!(out, "ITEM: ENTRIES index btype batom1 batom2")?;
    for (at, (ends, _)) in whole().enumerate() {
        let [a, b] = ends.map(|end| frame.ids[end as usize] + 1);
        writeln!(out, "{} 1 {a} {b}", at + 1)?;
    }
    Ok(())
}
