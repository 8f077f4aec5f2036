//! Positions of bodies that follow from their particles: `position_of = "centre"`, and `drop`.

use std::collections::BTreeMap;

use dem_io::{Body, Result};
use dem_scene::{BodyEntry, ClumpMass, PositionOf, Scene, StartAs};
use nalgebra::{UnitQuaternion, Vector3};

use super::falls::drop_onto;
use dem_physics::shape::inertia::of_union;

/// The scene with the position of the origin of each body's file, and the velocity of bodies that
/// fall.
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
