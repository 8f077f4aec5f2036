//! Positions of bodies that follow from their particles: `position_of = "centre"`, and `drop`.

use std::collections::BTreeMap;

use dem_io::{Body, Diagnostic, Result};
use dem_scene::{BodyEntry, ClumpMass, Fall, PositionOf, Scene, StartAs, Wall, WallShape};
use nalgebra::{UnitQuaternion, Vector3};

use crate::shape::inertia::of_union;

/// Gap between a body that falls and its plane at the start, over the smallest radius of the body.
const GAP: f64 = 0.01;

/// The scene with the position of the origin of each body's file, and the velocity of bodies that
/// fall.
///
/// # Errors
/// Gravity does not point into the plane of a fall.
pub(super) fn placed(scene: &Scene, read: &BTreeMap<String, Body>) -> Result<Scene> {
    let mut placed = scene.clone();
    for (name, entry) in &mut placed.bodies {
        let Some(body) = read.get(name) else {
            continue;
        };
        if entry.position_of == PositionOf::Centre {
            let centre = turned(entry, centre_m(entry, body));
            entry.position_m = (Vector3::from(entry.position_m) - centre).into();
        }
        if let Some(fall) = entry.fall.clone() {
            drop_onto(scene, name, entry, body, &fall)?;
        }
    }
    Ok(placed)
}

/// Centre of mass of a body in the frame of its file, m.
fn centre_m(entry: &BodyEntry, body: &Body) -> [f64; 3] {
    let is_union =
        matches!(entry.start_as, StartAs::Clump(clump) if clump.mass == ClumpMass::Union);
    if is_union {
        return of_union(&body.positions, &body.radii, 1.0).centre_m;
    }
    let (mut moment, mut volume) = (Vector3::zeros(), 0.0);
    for (place, radius) in body.positions.iter().zip(&body.radii) {
        let weight = radius.powi(3);
        moment += weight * Vector3::from(*place);
        volume += weight;
    }
    (moment / volume).into()
}

fn turned(entry: &BodyEntry, place: [f64; 3]) -> Vector3<f64> {
    UnitQuaternion::from_scaled_axis(Vector3::from(entry.rotation_rad)) * Vector3::from(place)
}

/// Puts a body just above the plane, with the speed with which it touches it after its fall less
/// what it gains on the way left.
fn drop_onto(
    scene: &Scene,
    name: &str,
    entry: &mut BodyEntry,
    body: &Body,
    fall: &Fall,
) -> Result<()> {
    let Some((point, normal)) = scene.walls.get(&fall.onto).and_then(plane) else {
        return Ok(());
    };
    let gravity = Vector3::from(scene.run.gravity_m_s2);
    let down = gravity.normalize();
    // Cosine between the vertical and the normal.
    let facing = -down.dot(&normal);
    if facing <= 0.0 {
        return Err(Diagnostic::input(
            format!("{}: bodies.{name}.drop", scene.source),
            format!(
                "gravity does not point towards the free side of '{}'",
                fall.onto
            ),
            "name a plane below the body, or turn its normal round",
        ));
    }
    let shift = Vector3::from(entry.position_m);
    let scale = match entry.start_as {
        StartAs::Clump(clump) => clump.scale,
        StartAs::Bonded => 1.0,
    };
    let distance = |(place, radius): (&[f64; 3], &f64)| {
        (turned(entry, *place) + shift - point).dot(&normal) - scale * radius
    };
    let spheres = body.positions.iter().zip(&body.radii);
    let nearest_m = spheres.map(distance).fold(f64::INFINITY, f64::min);
    let smallest_m = body.radii.iter().copied().fold(f64::INFINITY, f64::min);
    let gap_m = (GAP * smallest_m / facing).min(fall.height_m);
    // Along the vertical, so that the body stays where it is across it.
    let down_m = nearest_m / facing - gap_m;
    entry.position_m = (shift + down_m * down).into();
    let speed_m_s = (2.0 * gravity.norm() * (fall.height_m - gap_m)).sqrt();
    entry.velocity_m_s = (speed_m_s * down).into();
    Ok(())
}

/// Point and normal of a plane at the start.
fn plane(wall: &Wall) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let WallShape::Plane { point_m, normal } = wall.shape else {
        return None;
    };
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(wall.rotation_rad));
    let pivot = Vector3::from(wall.pivot_m);
    let point = pivot + turn * (Vector3::from(point_m) - pivot);
    Some((point, turn * Vector3::from(normal)))
}
