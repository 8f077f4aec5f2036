//! Winding numbers: a ray is cast and its crossings with the facets are counted (Moeller and
//! Trumbore 1997; Platzer 2022, section 4.1.1).
//!
//! A ray that grazes a facet, an edge or a vertex is undecided: the next direction is tried.
//! Crossings are counted with their sense (out of the solid +1, into it -1), so that shells that
//! cross each other form their union.

use super::tree::{Corners, TriangleTree};
use crate::spheres::Vector3;

/// Directions in general position relative to the axes and to each other.
const DIRECTIONS: [[f64; 3]; 7] = [
    [0.577_215_66, 0.321_309_89, 0.751_988_48],
    [-0.414_213_56, 0.732_050_81, 0.540_963_27],
    [0.236_067_98, -0.645_751_31, 0.726_172_92],
    [-0.697_147_18, -0.308_029_99, 0.654_915_31],
    [0.138_629_44, 0.915_965_59, -0.376_652_10],
    [-0.850_112_37, 0.210_345_67, -0.482_731_99],
    [0.359_223_11, -0.473_112_29, -0.804_419_52],
];

/// The way in which a ray meets one triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Crossing {
    Miss,
    /// Crosses the inner part; the sign is +1 if the ray leaves through the side of the normal, -1
    /// if it enters.
    Hit(i32),
    /// Too near an edge, a vertex or the plane of the triangle to be sure.
    Unsure,
}

/// Moeller-Trumbore intersection of the ray `origin + t * direction`, t > 0, with a triangle.
/// Lengths in local units.
pub(super) fn moeller_trumbore(
    origin: &Vector3,
    direction: &Vector3,
    corners: &Corners,
) -> Crossing {
    const MARGIN: f64 = 1e-10;
    let [a, b, c] = corners.map(Vector3::from);
    let (edge_1, edge_2) = (b - a, c - a);
    let p = direction.cross(&edge_2);
    let determinant = edge_1.dot(&p);
    let size = edge_1.norm() * edge_2.norm();
    let from_a = origin - a;
    if determinant.abs() <= 1e-12 * size {
        // Parallel to the plane: harmless unless the ray runs within it.
        let normal = edge_1.cross(&edge_2);
        let off_plane = from_a.dot(&normal).abs();
        return if off_plane > 1e-9 * normal.norm() {
            Crossing::Miss
        } else {
            Crossing::Unsure
        };
    }
    let u = from_a.dot(&p) / determinant;
    let q = from_a.cross(&edge_1);
    let v = direction.dot(&q) / determinant;
    if u < -MARGIN || v < -MARGIN || u + v > 1.0 + MARGIN {
        return Crossing::Miss;
    }
    let t = edge_2.dot(&q) / determinant;
    if t < -1e-12 {
        return Crossing::Miss;
    }
    if t < 1e-12 || u < MARGIN || v < MARGIN || u + v > 1.0 - MARGIN {
        return Crossing::Unsure;
    }
    // The determinant is -(direction . normal): negative where the ray leaves through the outer
    // side.
    Crossing::Hit(if determinant < 0.0 { 1 } else { -1 })
}

/// Winding number of the surface around a point (local units): 1 inside one shell, 0 outside.
/// `None` if it cannot be decided, as on the surface itself.
pub(super) fn winding(facets: &TriangleTree, point: &Vector3) -> Option<i32> {
    DIRECTIONS
        .iter()
        .find_map(|d| crossings(facets, point, &Vector3::from(*d)))
}

/// Signed crossings of a ray; `None` when a facet was grazed.
fn crossings(facets: &TriangleTree, origin: &Vector3, direction: &Vector3) -> Option<i32> {
    let mut winding = 0;
    for facet in facets.on_ray(origin, direction) {
        match moeller_trumbore(origin, direction, &facets.corners(facet)) {
            Crossing::Miss => {}
            Crossing::Hit(sign) => winding += sign,
            Crossing::Unsure => return None,
        }
    }
    Some(winding)
}
