//! `dem-run fragment --all`: every fragment of a frame as a file of its own.

use std::path::{Path, PathBuf};

use dem_io::body::{StoredFrame, vtp};
use dem_io::safe_write::PendingFile;
use dem_io::stl::write_stl;
use dem_io::text::visible;
use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_physics::shape::hull::{SMALLER_BY, convex_hull};
use dem_terminal::standard_output::write_standard_output;

use super::fragment_body::fragment_body;
use super::new_folder::NewFolder;

/// Millimetres in a metre: STL files are in millimetres, as dem-pack and scenes read them.
const MM: f64 = 1e3;

/// Writes all fragments of a frame, whose file is `path`, into the empty folder `output`: their
/// convex hulls as STL, or their particles and bonds as bodies. All files appear, or none.
pub(super) fn write_all(
    frame: &StoredFrame,
    path: &Path,
    output: &Path,
    as_hulls: bool,
    quiet: bool,
) -> Result<()> {
    let place = output.display().to_string();
    if output == Path::new("-") {
        return Err(Diagnostic::input(
            "--all",
            "no folder is named",
            "add --output FOLDER",
        ));
    }
    let folder = NewFolder::make(output, "--output")?;
    let count = write_files(frame, path, output, as_hulls)?;
    folder.keep();
    if quiet {
        return Ok(());
    }
    let what = if as_hulls {
        format!("convex hulls, in mm, of the spheres, at most {SMALLER_BY} of a radius smaller")
    } else {
        "bodies".to_owned()
    };
    write_standard_output(|out| {
        let s = if count == 1 { "" } else { "s" };
        writeln!(
            out,
            "{count} fragment{s} at {} s -> {}: {what}",
            significant(frame.time_s, 6),
            visible(&place)
        )
    })
}

/// Writes the files, and returns their number.
fn write_files(frame: &StoredFrame, path: &Path, output: &Path, as_hulls: bool) -> Result<usize> {
    let members = frame.members();
    let mut pending: Vec<PendingFile> = Vec::with_capacity(members.len());
    for (&id, members) in &members {
        let named = |error: Diagnostic| error.within(&format!("fragment {id}"));
        if as_hulls {
            let centres_m: Vec<[f64; 3]> = members.iter().map(|&i| frame.positions[i]).collect();
            let radii_m: Vec<f64> = members.iter().map(|&i| frame.radii[i]).collect();
            let facets = convex_hull(&centres_m, &radii_m).map_err(named)?;
            let facets: Vec<[[f64; 3]; 3]> = facets
                .iter()
                .map(|facet| facet.map(|corner| corner.map(|x| MM * x)))
                .collect();
            let file = file_of(output, id, "stl");
            let header = format!(
                "fragment {id}, convex hull of {} spheres, mm",
                members.len()
            );
            pending.push(PendingFile::write(&file, |out| {
                write_stl(&header, &facets, out)
            })?);
        } else {
            let body = fragment_body(frame, path, id).map_err(named)?;
            body.check().map_err(named)?;
            let file = file_of(output, id, "vtp");
            pending.push(PendingFile::write(&file, |out| vtp::write(&body, out))?);
        }
    }
    let count = pending.len();
    pending.into_iter().try_for_each(PendingFile::publish)?;
    Ok(count)
}

/// `fragment_000123.stl`.
fn file_of(folder: &Path, id: u32, ending: &str) -> PathBuf {
    folder.join(format!("fragment_{id:06}.{ending}"))
}
