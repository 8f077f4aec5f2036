//! `dem-run fragment --all`: every fragment of a frame as a file of its own.

use std::path::{Path, PathBuf};

use dem_io::body::{StoredFrame, vtp};
use dem_io::safe_write::write_file;
use dem_io::stl::write_stl;
use dem_io::text::visible;
use dem_io::units::significant;
use dem_io::whole_folder::WholeFolder;
use dem_io::{Diagnostic, Result};
use dem_physics::shape::hull::{SMALLER_BY, convex_hull};
use dem_terminal::standard_output::write_standard_output;

use super::fragment_body::name_fragment;

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
    let folder = WholeFolder::beside(output, "--output")?;
    let count = write_files(frame, path, folder.path(), as_hulls)?;
    folder.publish()?;
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
fn write_files(frame: &StoredFrame, path: &Path, folder: &Path, as_hulls: bool) -> Result<usize> {
    let fragments = frame.members();
    for (&id, members) in &fragments {
        let particles = &members.particles;
        let named = |error: Diagnostic| error.within(&format!("fragment {id}"));
        if as_hulls {
            let centres_m: Vec<[f64; 3]> = particles.iter().map(|&i| frame.positions[i]).collect();
            let radii_m: Vec<f64> = particles.iter().map(|&i| frame.radii[i]).collect();
            let facets = convex_hull(&centres_m, &radii_m).map_err(named)?;
            let facets: Vec<[[f64; 3]; 3]> = facets
                .iter()
                .map(|facet| facet.map(|corner| corner.map(|x| MM * x)))
                .collect();
            let file = file_of(folder, id, "stl");
            let header = format!(
                "fragment {id}, convex hull of {} spheres, mm",
                particles.len()
            );
            write_file(&file, |out| write_stl(&header, &facets, out))?;
        } else {
            let mut body = frame.body_of(id, members).map_err(named)?;
            name_fragment(&mut body, path, id);
            body.check().map_err(named)?;
            let file = file_of(folder, id, "vtp");
            write_file(&file, |out| vtp::write(&body, out))?;
        }
    }
    Ok(fragments.len())
}

/// `fragment_000123.stl`.
fn file_of(folder: &Path, id: u32, ending: &str) -> PathBuf {
    folder.join(format!("fragment_{id:06}.{ending}"))
}
