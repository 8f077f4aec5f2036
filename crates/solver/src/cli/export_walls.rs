//! The walls of all frames as STL files.

use std::path::Path;

use dem_io::body::{StoredWalls, read_walls};
use dem_io::safe_write::write_file;
use dem_io::stl::write_stl;
use dem_io::text::visible;
use dem_io::{Diagnostic, Result};
use dem_results::folder::walls_in;

/// Writes the walls of these frames into a folder, in metres, as the dumps are: a file for each
/// frame, or the first only if they never move. Refuses frames without walls.
pub(super) fn write_wall_files(results: &Path, numbers: &[usize], folder: &Path) -> Result<()> {
    let Some(&first) = numbers.first().filter(|&&n| walls_in(results, n).is_file()) else {
        return Err(Diagnostic::input(
            results.display().to_string(),
            "its frames have no walls",
            "leave out --walls",
        ));
    };
    let start = read_walls(&walls_in(results, first))?;
    write_stl_of(&start, folder, first)?;
    let mut move_at_all = false;
    for (i, &number) in numbers.iter().enumerate().skip(1) {
        let walls = read_walls(&walls_in(results, number))?;
        if walls.points_m != start.points_m && !move_at_all {
            move_at_all = true;
            for &still in &numbers[1..i] {
                write_stl_of(&start, folder, still)?;
            }
        }
        if move_at_all {
            write_stl_of(&walls, folder, number)?;
        }
    }
    Ok(())
}

fn write_stl_of(walls: &StoredWalls, folder: &Path, number: usize) -> Result<()> {
    let corner = |point: u32| walls.points_m[point as usize];
    let facets: Vec<[[f64; 3]; 3]> = (walls.triangles.iter())
        .map(|triangle| triangle.map(corner))
        .collect();
    let header = format!("walls {}, m", visible(&walls.names.join(", ")));
    write_file(&folder.join(format!("walls_{number:06}.stl")), |out| {
        write_stl(&header, &facets, out)
    })
}
