//! `dem-run export RESULTS`: all frames of a run as a dump of LAMMPS, as OVITO reads it.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use dem_io::body::{StoredParticles, read_particles};
use dem_io::safe_write::PendingFile;
use dem_io::text::visible;
use dem_io::units::significant;
use dem_io::vtk::exact;
use dem_io::whole_folder::WholeFolder;
use dem_io::write_target::need_folder_of;
use dem_io::{Bounds, Diagnostic, Result};
use dem_results::folder::{frame_in, frames_in};
use dem_terminal::standard_output::write_standard_output;

use super::export_walls::write_wall_files;
use super::fragment::refuse_overwriting_files;

#[derive(Debug, Args)]
pub(super) struct FramesArguments {
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
    /// Write the walls to this folder, new or empty, as STL in metres: walls_000123.stl for each
    /// frame, or only the first if they never move
    #[arg(long, value_name = "FOLDER")]
    walls: Option<PathBuf>,
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

/// Writes all frames, and their bonds and walls if asked for. All files appear, or none.
pub(super) fn export_frames(arguments: &FramesArguments) -> Result<()> {
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
    let mut pending = vec![write_dump(
        results,
        &numbers,
        &arguments.output,
        &mut particle_section,
    )?];
    let mut thinnest_m = f64::INFINITY;
    if let Some(path) = &arguments.bonds {
        let mut section = |frame: &StoredParticles, number: usize, out: &mut dyn Write| {
            let widths = (frame.bond_radii.iter()).map(|radius_m| 2.0 * radius_m);
            thinnest_m = widths.fold(thinnest_m, f64::min);
            bond_section(frame, number, out)
        };
        pending.push(write_dump(results, &numbers, path, &mut section)?);
    }
    let folder = arguments.walls.as_deref();
    let folder = folder.map(|folder| WholeFolder::beside(folder, "--walls"));
    let folder = folder.transpose()?;
    if let Some(folder) = &folder {
        write_wall_files(results, &numbers, folder.path())?;
    }
    pending.into_iter().try_for_each(PendingFile::publish)?;
    if let Some(folder) = folder {
        folder.publish()?;
    }
    if arguments.quiet {
        return Ok(());
    }
    let said = Said {
        frames: numbers.len(),
        targets: targets.iter().chain(&arguments.walls).collect(),
        bonds: arguments.bonds.as_deref(),
        thinnest_m,
    };
    write_standard_output(|out| said.write(out))
}

/// What is said at the end.
struct Said<'a> {
    frames: usize,
    targets: Vec<&'a PathBuf>,
    /// The file of the bonds.
    bonds: Option<&'a Path>,
    /// Diameter of the thinnest bond, m. Infinite: there is none.
    thinnest_m: f64,
}

impl Said<'_> {
    fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let s = if self.frames == 1 { "" } else { "s" };
        let name = |file: &Path| visible(&file.display().to_string()).to_string();
        let files: Vec<String> = self.targets.iter().map(|file| name(file)).collect();
        writeln!(out, "{} frame{s} -> {}", self.frames, files.join(", "))?;
        let Some(bonds) = self.bonds.filter(|_| self.thinnest_m.is_finite()) else {
            return Ok(());
        };
        writeln!(
            out,
            "In OVITO, map width_m of {} to Width, or set the width of bonds to {} (m): without, bonds are 0.4 m wide",
            name(bonds),
            significant(self.thinnest_m, 2)
        )
    }
}

/// What writes the section of a frame: the frame, its number, where to.
type Section<'a> = &'a mut dyn FnMut(&StoredParticles, usize, &mut dyn Write) -> io::Result<()>;

/// Writes a section for each frame.
fn write_dump(
    results: &Path,
    numbers: &[usize],
    output: &Path,
    section: Section<'_>,
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

/// The particles of a frame. LAMMPS counts ids and types from 1; OVITO names the types by the
/// column `element`.
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
    writeln!(
        out,
        "ITEM: ATOMS id type element radius x y z vx vy vz body{last}"
    )?;
    for i in 0..frame.positions.len() {
        let body = frame.bodies[i];
        // Names consist of letters, digits, - and _.
        let name = frame.body_names.get(body as usize);
        write!(
            out,
            "{} {} {} {}",
            frame.ids[i] + 1,
            body + 1,
            name.map_or("-", String::as_str),
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

/// The unbroken bonds of a frame, by the ids of their particles, with their diameters.
fn bond_section(frame: &StoredParticles, number: usize, out: &mut dyn Write) -> io::Result<()> {
    head(frame, number, out)?;
    let unbroken = || (0..frame.bonds.len()).filter(|&bond| !frame.broken[bond]);
    writeln!(out, "ITEM: NUMBER OF ENTRIES\n{}", unbroken().count())?;
    box_bounds(frame, out)?;
    writeln!(out, "ITEM: ENTRIES index btype batom1 batom2 width_m")?;
    for (at, bond) in unbroken().enumerate() {
        let [a, b] = frame.bonds[bond].map(|end| frame.ids[end as usize] + 1);
        let width_m = exact(2.0 * frame.bond_radii[bond]);
        writeln!(out, "{} 1 {a} {b} {width_m}", at + 1)?;
    }
    Ok(())
}
