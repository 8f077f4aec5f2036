//! Directions, which may be invalid.

use nalgebra::Vector3;

/// The unit vector, if it exists.
pub(crate) fn unit(a: Vector3<f64>) -> Option<Vector3<f64>> {
    let length = a.norm();
    length.is_normal().then(|| a / length)
}

/// A unit vector perpendicular to a unit vector: horizontal if possible.
pub(crate) fn across(a: Vector3<f64>) -> Vector3<f64> {
    unit(Vector3::z().cross(&a))
        .filter(|_| a.x.abs().max(a.y.abs()) > 1e-9)
        .unwrap_or(Vector3::x())
}
