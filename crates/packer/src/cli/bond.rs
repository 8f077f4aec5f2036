//! `dem-pack bond`: bonds for the spheres of a file.

use super::arguments::BondCommand;
use crate::bond_spheres::bond_spheres;
use dem_io::body::{
    NO_FRAME, body_summary, files::body_files, read_particles, read_spheres, write_body,
};
use dem_io::text::visible;
use dem_io::write_target::{need_folder_of, refuse_to_replace};
use dem_io::{Body, Diagnostic, Result};
use dem_terminal::standard_output::write_standard_output;
use std::path::Path;

/// Bonds the spheres of the file, writes the body and describes it. Refuses bonded spheres whose
/// bonds are not to be replaced.
pub(super) fn bond(command: &BondCommand) -> Result<()> {
    let settings = command.bonds.checked()?;
    let (from, to) = (&command.spheres, &command.output);
    let files = body_files(to)?;
    files.iter().try_for_each(|file| need_folder_of(file))?;
    let mut read = body_files(from)?;
    read.push(from.clone());
    refuse_to_replace(&files, &read)?;
    let place = from.display().to_string();
    let mut spheres = spheres_of(from)?;
    if !spheres.bonds.is_empty() && !command.replace {
        return Err(Diagnostic::input(
            place,
            format!(
                "the spheres are bonded already, by {} bonds",
                spheres.bonds.len()
            ),
            "--replace bonds them anew",
        ));
    }
    spheres.about = command.about(spheres.about)?;
    spheres.about.source.get_or_insert_with(|| place.clone());
    let (body, quality) = bond_spheres(&spheres, &settings).map_err(|e| e.within(&place))?;
    write_body(&body, to)?;
    if command.quiet || to == Path::new("-") {
        return Ok(());
    }
    write_standard_output(|out| {
        let name = to.display().to_string();
        writeln!(out, "{} -> {}", visible(&place), visible(&name))?;
        write!(out, "{}{}", body_summary(&body), quality.line())
    })
}

/// A body, or the loose spheres of a frame of a run.
fn spheres_of(file: &Path) -> Result<Body> {
    if file.extension().is_none_or(|ending| ending != "vtp") {
        return read_spheres(file);
    }
    match read_particles(file) {
        Ok(frame) => frame
            .loose_spheres()
            .map_err(|e| e.within(&file.display().to_string())),
        Err(error) if error.problem.starts_with(NO_FRAME) => read_spheres(file),
        Err(error) => Err(error),
    }
}
