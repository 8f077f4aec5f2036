//! What contacts have done to the patches of walls, from `wall_loads.vtp`: pictures of the walls in
//! colours, and the hot spots.

use std::path::{Path, PathBuf};

use dem_io::units::show_quantity;
use dem_io::{Bounds, Diagnostic, Result};
use dem_pictures::label::{colour_bar, scale_bar};
use dem_pictures::png_file::{Compression, to_png};
use dem_pictures::surface::Triangle;
use dem_pictures::{Camera, Surface, render};
use dem_plots::viridis;
use dem_results::folder::names::WALL_LOAD_CELLS;
use dem_results::read_arrays;

use super::load_cells::LoadCells;
pub use super::load_cells::WallQuantity;

/// Number of colours: patches of one colour are drawn together.
const COLOURS: usize = 64;
/// Most triangles of which borders and folds are drawn: to find them takes a while.
const MOST_WITH_LINES: usize = 200_000;

/// A picture of the walls with `loads` of the run in this folder, as PNG: coloured by a quantity,
/// seen from a direction of any length, or where that is None from where the loads come, with a
/// magnification and a place in the middle, m, or everything.
///
/// # Errors
/// The run has no such walls, or its file is damaged.
pub fn wall_picture(
    folder: &Path,
    by: WallQuantity,
    from: Option<[f64; 3]>,
    (target_m, zoom): (Option<[f64; 3]>, f64),
    size_px: [u32; 2],
) -> Result<Vec<u8>> {
    let path = cells_of(folder)?;
    let cells = LoadCells::read(&path)?;
    let which = WallQuantity::WORDS.iter().position(|(_, one)| *one == by);
    let values: Vec<f64> = (cells.values.iter())
        .map(|of| of[which.unwrap_or(0)])
        .collect();
    let (name, unit) = by.label();
    let highest = values.iter().copied().fold(0.0, f64::max);
    let points_m = || cells.triangles_m.iter().flatten().copied();
    let bounds = Bounds::of(points_m());
    let direction = match from {
        Some(from) => from.map(|part| -part),
        None => sight(impulse_n_s(&path)?, &bounds),
    };
    let middle_m = [0, 1, 2].map(|k| 0.5 * (bounds.low[k] + bounds.high[k]));
    let target_m = target_m.unwrap_or(middle_m);
    let shown = points_m().map(|at| [0, 1, 2].map(|k| target_m[k] + (at[k] - middle_m[k]) / zoom));
    let shown: Vec<[f64; 3]> = shown.collect();
    let camera = Camera::around(direction, [0.0, 0.0, 1.0], &shown, size_px);
    let mut image = render(
        &camera,
        &[],
        &surfaces(&cells.triangles_m, &values, highest),
    );
    let ends = ["0".to_owned(), show_quantity(highest, unit)];
    colour_bar(&mut image, name, [&ends[0], &ends[1]], &viridis);
    scale_bar(&mut image, camera.px_per_m());
    to_png(&image, Compression::High)
}

/// From where the loads come to where they go, a little from above and the side; of loads that
/// cancel each other the usual direction.
fn sight(impulse_n_s: [f64; 3], bounds: &Bounds) -> [f64; 3] {
    let norm = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
    let usual = Camera::three_quarter_direction(bounds);
    let (load, usual_norm) = (norm(impulse_n_s), norm(usual));
    if load == 0.0 {
        return usual;
    }
    [0, 1, 2].map(|k| impulse_n_s[k] / load + 0.5 * usual[k] / usual_norm)
}

/// The patches by their colours, and the lines of the walls.
fn surfaces(triangles_m: &[[[f64; 3]; 3]], values: &[f64], highest: f64) -> Vec<Surface> {
    let mut of_colours = vec![Vec::new(); COLOURS];
    for (corners_m, value) in triangles_m.iter().zip(values) {
        let fraction = (value / highest.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let colour = (fraction * (COLOURS - 1) as f64).round() as usize;
        of_colours[colour].push(Triangle {
            corners_m: *corners_m,
        });
    }
    let vertices_m: Vec<[f64; 3]> = triangles_m.iter().flatten().copied().collect();
    let lined = match triangles_m.len() {
        count if count <= MOST_WITH_LINES => count as u32,
        _ => 0,
    };
    let triangles = (0..lined).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    let lines = Surface {
        opacity: 1.0,
        ..Surface::mesh(&vertices_m, &triangles.collect::<Vec<_>>())
    };
    let of_colour = |(number, triangles)| Surface {
        triangles,
        edges: Vec::new(),
        colour: viridis(number as f64 / (COLOURS - 1) as f64),
        ..lines
    };
    let mut all: Vec<Surface> = of_colours.into_iter().enumerate().map(of_colour).collect();
    all.push(Surface {
        triangles: Vec::new(),
        ..lines
    });
    all
}

/// Path of the patches of the run in this folder.
fn cells_of(folder: &Path) -> Result<PathBuf> {
    let path = folder.join(WALL_LOAD_CELLS);
    if !path.is_file() {
        return Err(Diagnostic::input(
            path.display().to_string(),
            "there is no such file: no wall of the run has loads",
            "write loads = { patch = \"20 mm\" } in a [walls.NAME] of the scene, loads = {} if it has stl, and run it again",
        ));
    }
    Ok(path)
}

/// Impulse of all triangles in such a file, N s: its direction is that of the loads.
fn impulse_n_s(path: &Path) -> Result<[f64; 3]> {
    let names = ["x", "y", "z"].map(|axis| format!("CellData/impulse_{axis}_n_s"));
    let arrays = read_arrays(path, &names.each_ref().map(String::as_str))?;
    Ok(names.map(|name| arrays.get(&name).unwrap_or_default().iter().sum()))
}
