//! Walls of a scene, put where they start.

use std::path::Path;

use dem_io::scene::{Scene, StartOverlap, Wall as SceneWall, WallShape};
use dem_io::surface::{OpenSurface, read_open_surface};
use dem_io::units::show_length;
use dem_io::{Diagnostic, Result};

use super::bodies::{PlacedBody, called};
use super::contacts::{Kinds, ROUNDING};
use crate::geometry::{Bounds, Cylinder, Frame, Mesh, Plane, Shape, SolidBox, Touch};
use crate::physics::rigid::turn;
use crate::state::State;
use crate::state::contacts::Memory;
use crate::state::walls::{Wall, WallTouch};

/// A wall whose size over that of all bodies together is outside this makes one ask for its unit.
const OTHER_UNIT: [f64; 2] = [1.0 / 50.0, 300.0];

/// The walls of a scene, in the order of their names. What is odd about them but harmless goes to `notes`.
///
/// # Errors
/// A file that is no surface; a pair of materials that may meet without a word on how; particles in walls, unless they may.
pub(super) fn place_walls(
    scene: &Scene,
    kinds: &Kinds<'_>,
    bodies: &[PlacedBody],
    state: &State,
    notes: &mut Vec<String>,
) -> Result<Vec<Wall>> {
    let places = state.particles.poses.iter().map(|pose| pose.place().into());
    let of_clumps = state.clumps.templates.iter().map(|t| 2.0 * t.reach_m);
    let extent_m = (Bounds::of(places).diagonal_m().max(0.0)
        + 2.0 * state.particles.largest_radius_m())
    .max(of_clumps.fold(0.0, f64::max));
    let mut walls = Vec::new();
    for (name, entry) in &scene.walls {
        let place = format!("{}: [walls.{name}]", scene.source);
        for body in bodies {
            let pair = [&scene.bodies[&body.name].material, &entry.material];
            let who = format!("the body '{}' and the wall '{name}' need", body.name);
            kinds.need(scene, pair.map(|m| kinds.material(m)), &who)?;
        }
        for template in &state.clumps.templates {
            let pair = [
                usize::from(template.material),
                kinds.material(&entry.material),
            ];
            let who = format!("the body '{}' and the wall '{name}' need", template.body);
            kinds.need(scene, pair, &who)?;
        }
        let shape = shape(entry, name, notes).map_err(|error| error.within(&place))?;
        question_size(name, entry, &shape, extent_m, notes);
        let material = kinds.material(&entry.material);
        let mut wall = Wall {
            name: name.clone(),
            kind_of: kinds.row(material).to_vec(),
            kinds: kinds.kinds.clone(),
            surface_velocity_m_s: entry.surface_velocity_m_s,
            motion: entry.motion.clone(),
            ..Wall::standing(shape, frame(entry))
        };
        let touches = starting_touches(&wall, state);
        let is_through = touches.iter().any(|(_, touch)| touch.distance_m < 0.0);
        if is_through || scene.run.start_overlap == StartOverlap::Refuse {
            refuse_touches(&place, name, &wall, &touches, bodies, state)?;
        }
        wall.touching = touches
            .iter()
            .map(|(particle, touch)| relaxing(*particle, touch, state))
            .collect();
        walls.push(wall);
    }
    Ok(walls)
}

/// The shape in the wall's own frame, whose origin is the pivot.
fn shape(entry: &SceneWall, name: &str, notes: &mut Vec<String>) -> Result<Shape> {
    let from_pivot = |point: [f64; 3]| [0, 1, 2].map(|k| point[k] - entry.pivot_m[k]);
    Ok(match &entry.shape {
        WallShape::Plane { point_m, normal } => {
            Shape::Plane(Plane::new(from_pivot(*point_m), *normal)?)
        }
        WallShape::Box { min, max } => {
            Shape::Box(SolidBox::new(from_pivot(*min), from_pivot(*max))?)
        }
        WallShape::Cylinder {
            from_m,
            to_m,
            radius_m,
        } => Shape::Cylinder(Cylinder::new(
            [from_pivot(*from_m), from_pivot(*to_m)],
            *radius_m,
        )?),
        WallShape::Stl {
            path,
            unit_m,
            scale,
        } => {
            let mut surface = surface_of(path, unit_m * scale)?;
            for vertex in &mut surface.vertices_m {
                *vertex = from_pivot(*vertex);
            }
            let mesh = Mesh::from_surface(&surface)?;
            let dropped = surface.degenerate_facets + mesh.content.degenerate;
            if dropped > 0 {
                notes.push(format!(
                    "wall '{name}': {dropped} facets without area were dropped"
                ));
            }
            if mesh.content.open_edges > 0 {
                notes.push(format!(
                    "wall '{name}': the surface is open ({} edges of one triangle only); it pushes on both sides",
                    mesh.content.open_edges
                ));
            } else if signed_volume(&surface.vertices_m, &surface.triangles) < 0.0 {
                notes.push(format!(
                    "wall '{name}': the surface is inside out; it pushes on both sides, so nothing changes"
                ));
            }
            notes.extend(
                surface
                    .warnings
                    .iter()
                    .map(|w| format!("wall '{name}': {w}")),
            );
            Shape::Mesh(mesh)
        }
    })
}

/// The surface of a file that a scene names, in m.
pub(super) fn surface_of(path: &Path, unit_m: f64) -> Result<OpenSurface> {
    let file = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|error| {
        Diagnostic::input(
            &file,
            format!("cannot be read: {error}"),
            "check its name: it counts from the scene's folder",
        )
    })?;
    read_open_surface(&bytes, &file, unit_m)
}

/// Volume that triangles enclose, m3: below 0 where they look inwards.
fn signed_volume(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> f64 {
    let of_one = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| nalgebra::Vector3::from(vertices[v as usize]));
        a.dot(&b.cross(&c)) / 6.0
    };
    triangles.iter().map(of_one).sum()
}

/// Turned as `rotation` says, then tilted about y, both about the pivot.
fn frame(entry: &SceneWall) -> Frame {
    let upright = [0.0, 0.0, 0.0, 1.0];
    Frame {
        position_m: entry.pivot_m,
        turned: turn(
            turn(upright, entry.rotation_rad),
            [0.0, entry.tilt_rad, 0.0],
        ),
    }
}

/// Asks for the unit of a surface that is out of all proportion.
fn question_size(
    name: &str,
    entry: &SceneWall,
    shape: &Shape,
    extent_m: f64,
    notes: &mut Vec<String>,
) {
    let WallShape::Stl { unit_m, .. } = &entry.shape else {
        return;
    };
    let size_m = shape.bounds().diagonal_m();
    let ratio = size_m / extent_m;
    if (OTHER_UNIT[0]..OTHER_UNIT[1]).contains(&ratio) {
        return;
    }
    let (times, than) = if ratio > 1.0 {
        (ratio, "larger")
    } else {
        (1.0 / ratio, "smaller")
    };
    notes.push(format!(
        "wall '{name}' is {} across, {times:.0} times {than} than all bodies together ({}): is a unit of its file {}?",
        show_length(size_m),
        show_length(extent_m),
        show_length(*unit_m),
    ));
}

/// What overlaps a wall at the start by more than rounding.
fn starting_touches(wall: &Wall, state: &State) -> Vec<(u32, Touch)> {
    let mut found = Vec::new();
    let mut of_one = Vec::new();
    let bounds = wall.shape.bounds();
    for (i, pose) in (0..).zip(&state.particles.poses) {
        let centre = wall.frame.to_wall(pose.place().into());
        let reach_m = pose.radius_m() * (1.0 - ROUNDING);
        if bounds.is_near(&centre, reach_m) {
            of_one.clear();
            wall.shape.touches(centre, reach_m, &mut of_one);
            let in_space = |touch: &Touch| wall.frame.touch_to_space(touch);
            found.extend(of_one.iter().map(|touch| (i, in_space(touch))));
        }
    }
    found
}

fn refuse_touches(
    place: &str,
    name: &str,
    wall: &Wall,
    touches: &[(u32, Touch)],
    bodies: &[PlacedBody],
    state: &State,
) -> Result<()> {
    let depth = |(i, touch): &&(u32, Touch)| {
        state.particles.poses[*i as usize].radius_m() - touch.distance_m
    };
    let Some(deepest) = touches.iter().max_by(|a, b| depth(a).total_cmp(&depth(b))) else {
        return Ok(());
    };
    let (i, touch) = deepest;
    let who = called(bodies, &state.clumps, *i);
    let more = match touches.len() {
        1 => String::new(),
        count => format!(", the deepest of {count} places"),
    };
    let is_behind = touch.distance_m < 0.0;
    let remedy = match (&wall.shape, is_behind) {
        (Shape::Plane(_), true) => {
            "turn the plane's normal to the side of the bodies, or move the bodies"
        }
        (_, true) => "move the body or the wall: its centre is inside",
        _ => {
            "move the body or the wall; or run.start_overlap = \"relax\" takes the overlap as the place where they begin to press"
        }
    };
    Err(Diagnostic::input(
        place,
        format!(
            "{who} is {} deep in the wall '{name}' at the start{more}",
            show_length(depth(&deepest))
        ),
        remedy,
    ))
}

/// A touch whose overlap is where the law begins.
fn relaxing(particle: u32, touch: &Touch, state: &State) -> WallTouch {
    let radius_m = state.particles.poses[particle as usize].radius_m();
    let memory = Memory::parted_at(radius_m - touch.distance_m);
    WallTouch {
        particle,
        feature: touch.feature,
        normal: touch.normal.map(|x| -x),
        memory,
    }
}
