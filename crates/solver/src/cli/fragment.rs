//! `dem-run fragment`: a fragment of a frame, or all its loose spheres, as a body.

use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args};
use dem_io::body::files::body_files;
use dem_io::body::mass::of_named_density;
use dem_io::body::write_body;
use dem_io::body::{StoredFragment, read_frame, read_particles};
use dem_io::text::visible;
use dem_io::units::significant;
use dem_io::write_target::{need_folder_of, refuse_input};
use dem_io::{Diagnostic, Result};
use dem_results::Summary;
use dem_results::checkpoint::read_checkpoint;
use dem_results::folder::{frame_in, frames_in, result_among};
use dem_scene::read_scene;
use dem_terminal::standard_output::write_standard_output;

use super::all_fragments::write_all;
use super::fragment_body::{fragment_body, name_origin};
use dem_runner::snapshot::Snapshot;

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("fragment").required(true).args(["id", "largest", "loose", "all"])))]
pub(super) struct FragmentArguments {
    /// The folder of results of a run
    results: PathBuf,
    /// Fragment id, as in the frames and in fragments.csv
    #[arg(long)]
    id: Option<u32>,
    /// Take the heaviest fragment
    #[arg(long)]
    largest: bool,
    /// Take all loose spheres together, as one body without bonds, which dem-pack bond bonds
    #[arg(long)]
    loose: bool,
    /// Take every fragment, each as a file of its own: fragment_000007.vtp and so on, in the folder
    /// that --output names
    #[arg(long)]
    all: bool,
    /// With --all: write convex hulls of the spheres as STL, in mm, instead of bodies
    #[arg(long)]
    stl: bool,
    /// Number of the frame, from 0; the last one unless given
    #[arg(long, value_name = "K")]
    frame: Option<usize>,
    /// The body to write, or with --all a new folder: .vtp, .data (LAMMPS), .csv, .txt; standard
    /// output if not given
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Only print warnings and errors
    #[arg(long, short)]
    quiet: bool,
}

/// Writes the requested fragment and describes it.
pub(super) fn fragment(arguments: &FragmentArguments) -> Result<()> {
    let output = &arguments.output;
    if arguments.stl && !arguments.all {
        let problem = "hulls are written of all fragments together";
        return Err(Diagnostic::input(
            "--stl",
            problem,
            "write --all --stl -o FOLDER",
        ));
    }
    if arguments.all {
        let path = frame_path(&arguments.results, arguments.frame)?;
        let frame = read_frame(&path)?;
        return write_all(&frame, &path, output, arguments.stl, arguments.quiet);
    }
    for file in body_files(output)? {
        need_folder_of(&file)?;
    }
    let path = frame_path(&arguments.results, arguments.frame)?;
    refuse_overwriting(&arguments.results, output)?;
    if arguments.loose {
        return write_loose(&path, output, arguments.quiet);
    }
    let frame = read_frame(&path)?;
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    let fragments = frame.fragments();
    let id = arguments
        .id
        .or(fragments.first().map(|heaviest| heaviest.id));
    let id = id.ok_or_else(|| within(Diagnostic::input("", "the frame has no particles", "")))?;
    let body = fragment_body(&frame, &path, id).map_err(within)?;
    write_body(&body, output)?;
    if arguments.quiet || output == Path::new("-") {
        return Ok(());
    }
    let found = fragments.iter().find(|fragment| fragment.id == id);
    let mass_kg = found.map_or(0.0, |&StoredFragment { mass_kg, .. }| mass_kg);
    write_standard_output(|out| {
        writeln!(
            out,
            "fragment {id} at {} s -> {}: {} particles, {} bonds, {} kg",
            significant(frame.time_s, 6),
            visible(&output.display().to_string()),
            body.positions.len(),
            body.bonds.len(),
            significant(mass_kg, 4)
        )
    })
}

/// Writes the loose spheres of the frame in this file as a body, and describes it.
fn write_loose(path: &Path, output: &Path, quiet: bool) -> Result<()> {
    let frame = read_particles(path)?;
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    let mut body = frame.loose_spheres().map_err(within)?;
    name_origin(&mut body, path, "loose spheres");
    write_body(&body, output)?;
    if quiet || output == Path::new("-") {
        return Ok(());
    }
    let mass = match of_named_density(&body) {
        Some(mass) => format!("{} kg", significant(mass.mass_kg, 4)),
        None => "whose densities differ or are not known".to_owned(),
    };
    write_standard_output(|out| {
        writeln!(
            out,
            "loose spheres at {} s -> {}: {} of {} particles, {mass}",
            significant(frame.time_s, 6),
            visible(&output.display().to_string()),
            body.positions.len(),
            frame.positions.len(),
        )
    })
}

/// Refuses to overwrite the results or the inputs of their run with the body, as far as the folder
/// lists them.
fn refuse_overwriting(results: &Path, output: &Path) -> Result<()> {
    refuse_overwriting_files(results, &body_files(output)?)
}

/// Refuses to overwrite the results or the inputs of their run with these files, as far as the
/// folder lists them.
pub(super) fn refuse_overwriting_files(results: &Path, targets: &[PathBuf]) -> Result<()> {
    if let Some(target) = result_among(results, targets) {
        return Err(Diagnostic::input(
            target.display().to_string(),
            format!("this is one of the results in '{}'", results.display()),
            "name another file with --output",
        ));
    }
    let inputs = inputs_of(results);
    targets
        .iter()
        .try_for_each(|target| refuse_input(&target.display().to_string(), target, &inputs))
}

/// The input files of the run with these results, according to its checkpoint and its summary.
fn inputs_of(results: &Path) -> Vec<PathBuf> {
    let mut inputs = Vec::new();
    let checkpoint = read_checkpoint(&results.join("checkpoint.dem"));
    if let Ok(snapshot) = checkpoint.and_then(|bytes| Snapshot::from_bytes(&bytes)) {
        inputs.extend(snapshot.files_of_scene());
    }
    if let Some(summary) = Summary::read(&results.join("summary.json")) {
        let scene = PathBuf::from(summary.scene);
        inputs.extend(
            read_scene(&scene, &[]).map_or_else(|_| vec![scene], |read| read.input_files()),
        );
    }
    inputs
}

/// The file of the frame with this number, or of the last one.
fn frame_path(results: &Path, number: Option<usize>) -> Result<PathBuf> {
    let place = results.display().to_string();
    let frames = frames_in(results)?;
    let Some(&last) = frames.last() else {
        return Err(Diagnostic::input(
            place,
            "there are no frames in this folder",
            "name the folder of results of a run",
        ));
    };
    let number = number.unwrap_or(last);
    if frames.binary_search(&number).is_err() {
        return Err(Diagnostic::input(
            format!("--frame {number}"),
            format!("there is no such frame in {place}"),
            format!("frames {} to {last} are there", frames[0]),
        ));
    }
    Ok(frame_in(results, number))
}
