//! Walls of a scene at their initial positions.

mod books;
mod machine;
mod surface;

use std::sync::Arc;

use dem_io::units::{show_length, significant};
use dem_io::{Diagnostic, Result};
use dem_scene::{InitialOverlap, PlaneShape, Scene, Wall as SceneWall, WallMotion, WallShape};
use nalgebra::{UnitQuaternion, Vector3};

use super::contacts::{Kinds, ROUNDING};
use dem_engine::stages::walls::joints::drop_doubles;
use dem_engine::stages::walls::touch_energy_j;
use dem_engine::state::State;
use dem_engine::state::bodies::{PlacedBody, called};
use dem_engine::state::contacts::ContactHistory;
use dem_engine::state::walls::{Wall, WallContact, WallModel};
use dem_physics::geometry::{Frame, Mesh, Shape, Touch};
use dem_physics::rigid::turn;
use dem_physics::rotation::{numbers, rotation};

use self::books::book_model;
pub use self::machine::stroke_m;
pub(super) use self::machine::{crossings, largest_step_s, refuse_long_step, shaking};
pub(super) use self::surface::surface_of;
use self::surface::{Sizes, question_size, surface_warnings};

/// Largest fraction of a belt's speed out of its plane: allows for rounding of written numbers.
const OFF_PLANE: f64 = 1e-6;

/// The walls of a scene, in the order of their names. What is unusual but harmless is added to
/// `notes`.
///
/// # Errors
/// A file that is not a surface; a pair of materials without a contact law that may meet; a belt
/// that leaves its plane; an overlap with particles that is not allowed.
pub(super) fn place_walls(
    scene: &Scene,
    kinds: &Kinds<'_>,
    bodies: &[PlacedBody],
    state: &State,
    notes: &mut Vec<String>,
) -> Result<Vec<Wall>> {
    let sizes = Sizes::of(state);
    let keeps = scene.run.initial_overlap == InitialOverlap::Keep;
    let mut walls = Vec::new();
    let mut touches_of = Vec::new();
    for (name, entry) in &scene.walls {
        let place = format!("{}: [walls.{name}]", scene.source);
        for body in bodies {
            let pair = [&scene.bodies[&body.name].material, &entry.material];
            let who = || format!("the body '{}' and the wall '{name}' need", body.name);
            kinds.need(scene, pair.map(|m| kinds.material(m)), who)?;
        }
        for template in &state.clumps.templates {
            let pair = [
                usize::from(template.material),
                kinds.material(&entry.material),
            ];
            let who = || format!("the body '{}' and the wall '{name}' need", template.body);
            kinds.need(scene, pair, who)?;
        }
        let shape = shape(entry, name, notes).map_err(|error| error.within(&place))?;
        notes.extend(question_size(name, entry, &shape, sizes));
        let frame = frame(entry);
        refuse_belt_off_plane(&place, entry, &frame)?;
        let material = kinds.material(&entry.material);
        let book = book_model(entry, &shape, &frame, state);
        let model = WallModel {
            name: name.clone(),
            book: book.map_err(|error| error.within(&place))?,
            shape,
            motion: entry.motion.clone(),
            surface_velocity_m_s: entry.surface_velocity_m_s,
            kind_of: kinds.row(material).to_vec(),
            kinds: kinds.kinds.clone(),
        };
        let mut wall = Wall::new(Arc::new(model), frame);
        if let WallMotion::Weight {
            direction,
            velocity_m_s,
            ..
        } = &entry.motion
        {
            wall.velocities_m_s = [direction.map(|d| velocity_m_s * d); 2];
        }
        // Bodies that only touch press so little that the contact is dropped, unless overlaps are
        // to be kept.
        let least_share = if keeps { 0.0 } else { ROUNDING };
        let touches = starting_touches(&wall, state, least_share);
        let is_through = touches.iter().any(|(_, touch)| touch.distance_m < 0.0);
        if is_through || scene.run.initial_overlap == InitialOverlap::Refuse {
            refuse_touches(&place, name, &wall, &touches, bodies, state)?;
        }
        touches_of.push(touches);
        walls.push(wall);
    }
    join_touches(&walls, state, &mut touches_of);
    for (wall, touches) in walls.iter_mut().zip(&touches_of) {
        wall.touching = touches
            .iter()
            .map(|(particle, touch)| at_start(*particle, touch, state, keeps))
            .collect();
        if let (true, Some(contacts)) = (keeps, &state.contacts) {
            let pressed = wall.touching.iter();
            let pressed =
                pressed.map(|touch| touch_energy_j(wall, contacts, &state.particles, touch));
            wall.scratch.elastic_j = pressed.sum();
        }
    }
    Ok(walls)
}

/// Keeps, where walls meet, one touch of each surface: see [`drop_doubles`]. The touches of each
/// wall are given by particle.
fn join_touches(walls: &[Wall], state: &State, touches_of: &mut [Vec<(u32, Touch)>]) {
    let mut all: Vec<(u32, usize, Touch)> = Vec::new();
    for (wall, touches) in touches_of.iter_mut().enumerate() {
        all.extend(
            touches
                .drain(..)
                .map(|(particle, touch)| (particle, wall, touch)),
        );
    }
    all.sort_by_key(|(particle, ..)| *particle);
    for own in all.chunk_by(|a, b| a.0 == b.0) {
        let mut touches: Vec<(usize, Touch)> = own.iter().map(|one| (one.1, one.2)).collect();
        let radius_m = state.particles.poses[own[0].0 as usize].radius_m();
        drop_doubles(walls, &mut touches, radius_m);
        for (wall, touch) in touches {
            touches_of[wall].push((own[0].0, touch));
        }
    }
}

/// The shape and frame of a wall at the start.
pub(super) fn standing(entry: &SceneWall, name: &str) -> Result<(Shape, Frame)> {
    // What is odd about it is said when the walls are placed.
    Ok((shape(entry, name, &mut Vec::new())?, frame(entry)))
}

/// The shape in the wall's own frame, whose origin is the pivot.
fn shape(entry: &SceneWall, name: &str, notes: &mut Vec<String>) -> Result<Shape> {
    entry
        .shape
        .in_frame_of(entry.pivot_m, |path, unit_m, scale| {
            let mut surface = surface_of(path, unit_m, scale)?;
            for vertex in &mut surface.vertices_m {
                *vertex = [0, 1, 2].map(|k| vertex[k] - entry.pivot_m[k]);
            }
            let mesh = Mesh::from_surface(&surface)?;
            notes.extend(
                surface_warnings(&surface, &mesh).map(|odd| format!("wall '{name}': {odd}")),
            );
            Ok(mesh)
        })
}

/// Refuses a belt whose surface velocity has a component normal to its plane.
fn refuse_belt_off_plane(place: &str, entry: &SceneWall, frame: &Frame) -> Result<()> {
    let WallShape::Plane(PlaneShape { normal, .. }) = &entry.shape else {
        return Ok(());
    };
    let belt = Vector3::from(entry.surface_velocity_m_s);
    let normal = Vector3::from(frame.direction_to_space(*normal));
    let off_m_s = belt.dot(&normal);
    if off_m_s.abs() <= OFF_PLANE * belt.norm() {
        return Ok(());
    }
    let along = belt - off_m_s * normal;
    let [x, y, z] = [0, 1, 2].map(|k| significant(along[k], 9));
    Err(Diagnostic::input(
        place,
        format!(
            "surface_velocity has {} m/s of {} m/s along the plane's normal, but a belt moves along its surface (at most {OFF_PLANE} of its speed off it)",
            significant(off_m_s, 4),
            significant(belt.norm(), 4)
        ),
        format!(
            "write surface_velocity = [{x}, {y}, {z}], which is its part along the plane; or velocity, if the wall as a whole is to move"
        ),
    ))
}

/// Frame at the start: rotated about the pivot by `rotation`, and where its motion begins.
fn frame(entry: &SceneWall) -> Frame {
    let upright = [0.0, 0.0, 0.0, 1.0];
    let (begins_m, leans) = beginning(&entry.motion);
    let drawn = rotation(turn(upright, entry.rotation_rad));
    Frame {
        position_m: (Vector3::from(entry.pivot_m) + begins_m).into(),
        turned: numbers(&(leans * drawn)),
    }
}

/// Where a motion begins: the way of the pivot from where the wall is drawn, m, and the rotation
/// about it.
pub(super) fn beginning(motion: &WallMotion) -> (Vector3<f64>, UnitQuaternion<f64>) {
    match motion {
        WallMotion::Orbit(orbit) => (orbit.place_m(0.0).into(), UnitQuaternion::identity()),
        WallMotion::Gyration(gyration) => (Vector3::zeros(), rotation(gyration.turned(0.0))),
        _ => (Vector3::zeros(), UnitQuaternion::identity()),
    }
}

/// Particles that overlap a wall at the start by more than this fraction of their radius.
fn starting_touches(wall: &Wall, state: &State, least_share: f64) -> Vec<(u32, Touch)> {
    let mut found = Vec::new();
    let mut of_one = Vec::new();
    let bounds = wall.model.shape.bounds();
    for (i, pose) in (0..).zip(&state.particles.poses) {
        let centre = wall.frame.to_wall(pose.place().into());
        let reach_m = pose.radius_m() * (1.0 - least_share);
        if bounds.is_near(&centre, reach_m) {
            of_one.clear();
            match &wall.model.shape {
                Shape::Mesh(mesh) if mesh.holds(centre) => {
                    of_one.push(mesh.touch_from_inside(centre));
                }
                shape => shape.touches(centre, reach_m, &mut of_one),
            }
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
    let remedy = match (&wall.model.shape, is_behind) {
        (Shape::Plane(_), true) => {
            "turn the plane's normal to the side of the bodies, or move the bodies"
        }
        (Shape::Mesh(_), true) => {
            "move the body or the wall: its centre is inside a closed surface whose normals look outwards, so a solid; if that is to be a container, export it with its normals inwards"
        }
        (_, true) => "move the body or the wall: its centre is inside",
        _ => {
            "move the body or the wall; or run.initial_overlap = \"relax\" takes the overlap as the origin of the contact law, and \"keep\" applies the full contact force"
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

/// A contact at the start: its overlap is the origin of the law, or presses if it is kept.
fn at_start(particle: u32, touch: &Touch, state: &State, keeps: bool) -> WallContact {
    let overlap_m = state.particles.poses[particle as usize].radius_m() - touch.distance_m;
    let history = if keeps {
        ContactHistory::pressed_by(overlap_m)
    } else {
        ContactHistory::separated_at(overlap_m)
    };
    WallContact {
        particle,
        feature: touch.feature,
        normal: touch.normal.map(|x| -x),
        history,
    }
}
