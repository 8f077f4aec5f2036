//! Where the walls of a test are at the start.

use dem_scene::Wall;
use nalgebra::{UnitQuaternion, Vector3};

/// Initial position of a point of a wall's shape.
pub(super) fn placed(wall: &Wall, point_m: [f64; 3]) -> Vector3<f64> {
    let turned = UnitQuaternion::from_scaled_axis(Vector3::from(wall.rotation_rad));
    let pivot = Vector3::from(wall.pivot_m);
    pivot + turned * (Vector3::from(point_m) - pivot)
}

/// The middle of a wall. None: it is not known where the surface of a file would meet the
/// body.
pub(super) fn middle_of(wall: &Wall) -> Option<Vector3<f64>> {
    let [from, to] = wall.shape.ends_m()?;
    Some(0.5 * (placed(wall, from) + placed(wall, to)))
}
