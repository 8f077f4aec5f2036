//! The walls of all frames as STL files.

use std::path::Path;

use dem_io::body::{StoredWalls, read_walls};
use dem_io::safe_write::PendingFile;
use dem_io::stl::write_stl;
use dem_io::text::visible;
use dem_io::{Diagnostic, Result};
use dem_results::folder::walls_in;

/// Writes the walls of these frames into a folder, in metres, as the dumps are: a file for each
/// frame, or the first only if they never move. Refuses frames without walls.
pub(super) fn pending_walls(
    results: &Path,
    numbers: &[usize],
    folder: &Path,
) -> Result<Vec<PendingFile>> {
    let Some(&first) = numbers.first().filter(|&&n| walls_in(results, n).is_file()) else {
        return Err(Diagnostic::input(
            results.display().to_string(),
            "its frames have no walls",
            "leave out --walls",
        ));
    };
    let start = read_walls(&walls_in(results, first))?;
    let mut pending = vec![pending_stl(&start, folder, first)?];
    let mut move_at_all = false;
    for &number in &numbers[1..] {
        let walls = read_walls(&walls_in(results, number))?;
        move_at_all |= walls.points_m != start.points_m;
        pending.push(pending_stl(&walls, folder, number)?);
    }
    if !move_at_all {
        pending.truncate(1);
    }
    Ok(pending)
}

fn pending_stl(walls: &StoredWalls, folder: &Path, number: usize) -> Result<PendingFile> {
    let corner = |point: u32| walls.points_m[point as usize];
    let facets: Vec<[[f64; 3]; 3]> = (walls.triangles.iter())
        .map(|triangle| triangle.map(corner))
        .collect();
    let header = format!("walls {}, m", visible(&walls.names.join(", ")));
    PendingFile::write(&folder.join(format!("walls_{number:06}.stl")), |out| {
        write_stl(&header, &facets, out)
    })
}
