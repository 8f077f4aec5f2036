//! Geometry of bodies made of spheres, and free rotation: compared with published values, closed
//! forms and samples.

mod closed;
mod fit;
mod inertia;
mod outer_layer;
mod rotation;
mod thrown;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

pub(crate) fn unit(q: [f64; 4]) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::new(q[3], q[0], q[1], q[2]))
}

pub(crate) fn turned(q: &UnitQuaternion<f64>, points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    points
        .iter()
        .map(|p| (q * Vector3::from(*p)).into())
        .collect()
}

pub(crate) fn reference() -> serde_json::Value {
    serde_json::from_str(include_str!("shape/data/clump.json")).unwrap()
}
