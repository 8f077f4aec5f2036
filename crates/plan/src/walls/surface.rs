//! Surfaces of files of triangles: reading, notes and warnings.

use std::path::Path;

use dem_io::surface::{OpenSurface, read_open_surface};
use dem_io::triangles::read_triangle_file;
use dem_io::units::show_length;
use dem_io::{Diagnostic, Result};
use dem_scene::{Wall as SceneWall, WallShape};

use dem_engine::state::State;
use dem_engine::state::particles::Pose;
use dem_physics::geometry::{Bounds, Mesh, Shape};

/// A surface larger than all bodies together by this factor raises the question of its unit.
const TOO_LARGE: f64 = 300.0;
/// So does one smaller than all bodies by this factor, if it is also smaller than this many of
/// their spheres: otherwise it may be a pin or a tooth.
const TOO_SMALL: f64 = 50.0;
const OF_A_PIN: f64 = 3.0;

/// Sizes of bodies, including those still to be added, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sizes {
    /// Size of all bodies together.
    all_m: f64,
    /// Diameter of the largest sphere.
    sphere_m: f64,
}

impl Sizes {
    pub(super) fn of(state: &State) -> Self {
        let places = state.particles.poses.iter().map(Pose::place);
        let of_clumps = state.clumps.templates.iter().map(|t| 2.0 * t.reach_m);
        let standing_m =
            Bounds::of(places).diagonal_m().max(0.0) + 2.0 * state.particles.largest_radius_m();
        Self {
            all_m: of_clumps.fold(standing_m, f64::max),
            sphere_m: 2.0 * state.largest_radius_m(),
        }
    }
}

/// The surface from a file that a scene names, in m, with this unit, m, or its own, and this scale.
pub(crate) fn surface_of(path: &Path, unit_m: Option<f64>, scale: f64) -> Result<OpenSurface> {
    let file = path.display().to_string();
    let bytes = read_triangle_file(path).map_err(|error| {
        Diagnostic::input(
            &file,
            format!("cannot be read: {error}"),
            "check its name: it counts from the scene's folder, or with --set from where you stand",
        )
    })?;
    read_open_surface(&bytes, &file, unit_m, scale)
}

/// What is unusual in a surface, and its consequences.
pub(super) fn surface_warnings(surface: &OpenSurface, mesh: &Mesh) -> impl Iterator<Item = String> {
    let content = &mesh.content;
    let mut odd = Vec::new();
    let mut tell = |count: usize, [one, more]: [&str; 2]| match count {
        0 => {}
        1 => odd.push(format!("1 {one}")),
        count => odd.push(format!("{count} {more}")),
    };
    tell(
        surface.degenerate_facets + content.degenerate,
        [
            "facet without area was dropped: it bounds nothing",
            "facets without area were dropped: they bound nothing",
        ],
    );
    tell(
        surface.duplicate_facets,
        [
            "facet that stood there already was dropped: each counts once, so nothing changes",
            "facets that stood there already were dropped: each counts once, so nothing changes",
        ],
    );
    tell(
        surface.turned_facets,
        [
            "facet is turned against its neighbours: a surface pushes on both sides, so no force changes, but this one has no inside, and a body that starts in it is not found",
            "facets are turned against their neighbours: a surface pushes on both sides, so no force changes, but this one has no inside, and a body that starts in it is not found",
        ],
    );
    if content.open_edges > 0 {
        odd.push(format!(
            "the surface is open ({} edges of one triangle only); it pushes on both sides",
            content.open_edges
        ));
    } else if content.unpaired_edges == 0 && surface.is_inside_out {
        odd.push(
            "the surface is inside out: what it encloses is room, which inlets fill; it pushes on both sides".to_owned(),
        );
    }
    odd.extend(surface.warnings.iter().cloned());
    odd.into_iter()
}

/// Questions the unit of a surface whose size is out of proportion.
pub(super) fn question_size(
    name: &str,
    entry: &SceneWall,
    shape: &Shape,
    sizes: Sizes,
) -> Option<String> {
    let WallShape::Stl { unit_m, .. } = &entry.shape else {
        return None;
    };
    let Sizes { all_m, sphere_m } = sizes;
    let size_m = shape.bounds().diagonal_m();
    let than = if size_m > TOO_LARGE * all_m {
        let times = size_m / all_m;
        format!(
            "{times:.0} times larger than all bodies together ({})",
            show_length(all_m)
        )
    } else if size_m < sphere_m {
        format!("smaller than a single sphere ({})", show_length(sphere_m))
    } else if size_m < (all_m / TOO_SMALL).min(OF_A_PIN * sphere_m) {
        let times = all_m / size_m;
        format!(
            "{times:.0} times smaller than all bodies together ({})",
            show_length(all_m)
        )
    } else {
        return None;
    };
    let unit = match unit_m {
        Some(unit_m) => format!("a unit of its file {}", show_length(*unit_m)),
        None => "the unit in its file right".to_owned(),
    };
    Some(format!(
        "wall '{name}' is {} across, {than}: is {unit}?",
        show_length(size_m)
    ))
}
