//! What contacts have done to the patches of walls, from `wall_loads.vtp`: pictures of the walls in
//! colours, and the hot spots.

use std::path::Path;

use dem_io::units::show_quantity;
use dem_io::{Bounds, Diagnostic, Result};
use dem_pictures::label::{colour_bar, scale_bar};
use dem_pictures::png_file::{Compression, to_png};
use dem_pictures::surface::Triangle;
use dem_pictures::{Camera, Surface, render};
use dem_plots::viridis;
use dem_results::folder::names::WALL_LOAD_CELLS;
use dem_results::read_arrays;

/// What the colours of walls tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WallQuantity {
    /// Depth worn off, m.
    WearDepth,
    /// Energy of impacts over area, J/m2.
    Impact,
    /// Energy lost to friction over area, J/m2.
    Friction,
    /// Impulse along the normal over area, N s/m2.
    NormalImpulse,
}

impl WallQuantity {
    /// Their names.
    pub const WORDS: [(&'static str, Self); 4] = [
        ("wear_depth", Self::WearDepth),
        ("impact", Self::Impact),
        ("friction", Self::Friction),
        ("normal_impulse", Self::NormalImpulse),
    ];

    /// Its column, whether it is divided by the area, its name on a scale, and its unit.
    fn column(self) -> (&'static str, bool, &'static str, &'static str) {
        match self {
            Self::WearDepth => ("wear_depth_m", false, "wear depth", "m"),
            Self::Impact => ("impact_j", true, "impact energy over area", "J/m2"),
            Self::Friction => ("friction_j", true, "friction over area", "J/m2"),
            Self::NormalImpulse => (
                "normal_impulse_n_s",
                true,
                "normal impulse over area",
                "N s/m2",
            ),
        }
    }
}

/// Number of colours: patches of one colour are drawn together.
const COLOURS: usize = 64;
/// Most triangles of which borders and folds are drawn: to find them takes a while.
const MOST_WITH_LINES: usize = 200_000;

/// The patches as triangles, where the walls stood at the start.
struct Cells {
    /// Corners, m.
    triangles_m: Vec<[[f64; 3]; 3]>,
    /// On the scale. Length: triangles.
    values: Vec<f64>,
    /// Direction of the load of all patches, N s.
    impulse_n_s: [f64; 3],
}

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
    let cells = read(folder, by)?;
    let (.., name, unit) = by.column();
    let highest = cells.values.iter().copied().fold(0.0, f64::max);
    let points_m = || cells.triangles_m.iter().flatten().copied();
    let bounds = Bounds::of(points_m());
    let direction = match from {
        Some(from) => from.map(|part| -part),
        None => sight(&cells, &bounds),
    };
    let middle_m = [0, 1, 2].map(|k| 0.5 * (bounds.low[k] + bounds.high[k]));
    let target_m = target_m.unwrap_or(middle_m);
    let shown = points_m().map(|at| [0, 1, 2].map(|k| target_m[k] + (at[k] - middle_m[k]) / zoom));
    let shown: Vec<[f64; 3]> = shown.collect();
    let camera = Camera::around(direction, [0.0, 0.0, 1.0], &shown, size_px);
    let mut image = render(&camera, &[], &surfaces(&cells, highest));
    let ends = ["0".to_owned(), show_quantity(highest, unit)];
    colour_bar(&mut image, name, [&ends[0], &ends[1]], &viridis);
    scale_bar(&mut image, camera.px_per_m());
    to_png(&image, Compression::High)
}

/// From where the loads come to where they go, a little from above and the side; of loads that
/// cancel each other the usual direction.
fn sight(cells: &Cells, bounds: &Bounds) -> [f64; 3] {
    let norm = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
    let usual = Camera::three_quarter_direction(bounds);
    let (load, usual_norm) = (norm(cells.impulse_n_s), norm(usual));
    if load == 0.0 {
        return usual;
    }
    [0, 1, 2].map(|k| cells.impulse_n_s[k] / load + 0.5 * usual[k] / usual_norm)
}

/// The patches by their colours, and the lines of the walls.
fn surfaces(cells: &Cells, highest: f64) -> Vec<Surface> {
    let mut of_colours = vec![Vec::new(); COLOURS];
    for (corners_m, value) in cells.triangles_m.iter().zip(&cells.values) {
        let fraction = (value / highest.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let colour = (fraction * (COLOURS - 1) as f64).round() as usize;
        of_colours[colour].push(Triangle {
            corners_m: *corners_m,
        });
    }
    let vertices_m: Vec<[f64; 3]> = cells.triangles_m.iter().flatten().copied().collect();
    let lined = match cells.triangles_m.len() {
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

fn read(folder: &Path, by: WallQuantity) -> Result<Cells> {
    let path = folder.join(WALL_LOAD_CELLS);
    let place = path.display().to_string();
    if !path.is_file() {
        return Err(Diagnostic::input(
            place,
            "there is no such file: no wall of the run has loads",
            "write loads = { patch = \"20 mm\" } in a [walls.NAME] of the scene, loads = {} if it has stl, and run it again",
        ));
    }
    let (column, over_area, ..) = by.column();
    let (points, corners) = ("Points/positions_m", "Polys/connectivity");
    let cell = |name: &str| format!("CellData/{name}");
    let impulses = ["x", "y", "z"].map(|axis| cell(&format!("impulse_{axis}_n_s")));
    let (value, area) = (cell(column), cell("area_m2"));
    let [x, y, z] = &impulses;
    let arrays = read_arrays(&path, &[points, corners, &value, &area, x, y, z])?;
    let get = |name: &str| {
        let damaged = || Diagnostic::input(&place, format!("{name} is missing"), "run it again");
        arrays.get(name).ok_or_else(damaged)
    };
    let points_m = get(points)?;
    let point = |number: f64| {
        let first = 3 * number as usize;
        let at = points_m.get(first..first + 3);
        at.map_or([f64::NAN; 3], |at| [at[0], at[1], at[2]])
    };
    let triangles = get(corners)?.chunks_exact(3);
    let triangles_m = triangles.map(|t| [point(t[0]), point(t[1]), point(t[2])]);
    let values = get(&value)?.iter().zip(get(&area)?);
    let values = values.map(|(value, area_m2)| match over_area {
        true => value / area_m2,
        false => *value,
    });
    let mut impulse_n_s = [0.0; 3];
    for (sum, name) in impulse_n_s.iter_mut().zip(&impulses) {
        *sum = get(name)?.iter().sum();
    }
    Ok(Cells {
        triangles_m: triangles_m.collect(),
        values: values.collect(),
        impulse_n_s,
    })
}
