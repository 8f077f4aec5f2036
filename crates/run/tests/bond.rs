//! Bonds of a state compared with closed forms, and their energy.

mod damping_memory;
mod damping_order;
mod flat_joint;
mod lanes;
mod plasticity;
mod structural;

use nalgebra::Vector3;
use proptest::prelude::*;

/// Vectors in a cube of twice this edge.
pub(crate) fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}
