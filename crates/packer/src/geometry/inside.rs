//! Points inside the solid, and rays that meet its wall.

use super::boundary::Boundary;
use super::tree::Corners;
use super::winding::{Crossing, moeller_trumbore, winding};
use crate::spheres::Vector3;

/// True if the point (local units) lies inside the solid: within an outer shell and in no cavity.
/// A point on the surface itself is not inside.
pub fn is_inside(boundary: &Boundary, point: &Vector3) -> bool {
    winding(boundary.facets(), point).is_some_and(|winding| winding > 0)
}

/// Distance along a ray (unit direction, local units) to the first wall beyond the distance
/// `beyond`.
pub fn first_hit(
    boundary: &Boundary,
    origin: &Vector3,
    direction: &Vector3,
    beyond: f64,
) -> Option<f64> {
    let plane_distance = |corners: Corners| {
        let [a, b, c] = corners.map(Vector3::from);
        let normal = (b - a).cross(&(c - a));
        let distance = (a - origin).dot(&normal) / direction.dot(&normal);
        (moeller_trumbore(origin, direction, &corners) != Crossing::Miss && distance > beyond)
            .then_some(distance)
    };
    boundary
        .walls_on_ray(origin, direction)
        .filter_map(plane_distance)
        .min_by(f64::total_cmp)
}
