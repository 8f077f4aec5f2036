//! Triangles as planes: prepared for the point nearest to another.

use super::tree::Corners;
use crate::spheres::Vector3;

/// A triangle as the plane in which it lies: p is above it where u = (p - corner) . along_u >= 0,
/// v >= 0 and u + v <= 1.
pub(super) struct Plane {
    pub(super) corner: Vector3,
    pub(super) normal: Vector3,
    along_u: Vector3,
    along_v: Vector3,
}

/// Triangles whose height is a smaller fraction of their longest edge have no plane: its normal
/// would have an error of more than 1e-10.
const THINNEST: f64 = 1e-6;
/// Relative margin for rounding when distances are compared.
const MARGIN: f64 = 1e-9;

impl Plane {
    pub(super) fn new(corners: Corners) -> Self {
        let [a, b, c] = corners.map(Vector3::from);
        let (edge_u, edge_v) = (b - a, c - a);
        let normal = edge_u.cross(&edge_v);
        let longest = edge_u.norm().max(edge_v.norm()).max((c - b).norm());
        // The normal of a thin triangle is inaccurate, and hardly any points are above the
        // triangle. With NaN every comparison fails.
        let squared = if normal.norm() < THINNEST * longest * longest {
            f64::NAN
        } else {
            normal.norm_squared()
        };
        Self {
            corner: a,
            normal: normal / squared.sqrt(),
            along_u: edge_v.cross(&normal) / squared,
            along_v: normal.cross(&edge_u) / squared,
        }
    }

    /// u and v of a point given relative to the corner.
    pub(super) fn along_triangle(&self, from_corner: &Vector3) -> [f64; 2] {
        [&self.along_u, &self.along_v].map(|along| from_corner.dot(along))
    }

    /// Distance of a point from the plane, positive on the side of the normal, if it is above or
    /// below the triangle.
    pub(super) fn height_over_triangle(&self, point: &Vector3) -> Option<f64> {
        let from_corner = point - self.corner;
        let [u, v] = self.along_triangle(&from_corner);
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| from_corner.dot(&self.normal))
    }
}

/// The ball around a triangle: by far the smallest part of what is known about it, so that many are
/// excluded without reading the rest.
pub(super) struct Surroundings {
    pub(super) middle: Vector3,
    radius: f64,
}

impl Surroundings {
    pub(super) fn new(corners: Corners) -> Self {
        let [a, b, c] = corners.map(Vector3::from);
        let middle = (a + b + c) / 3.0;
        let to_corners = [a, b, c].map(|corner| (corner - middle).norm());
        Self {
            middle,
            radius: to_corners.into_iter().fold(0.0, f64::max),
        }
    }

    /// True if the triangle is certainly farther from a point than `reach`.
    pub(super) fn is_beyond(&self, point: &Vector3, reach: f64) -> bool {
        let reach = reach + self.radius;
        (point - self.middle).norm_squared() > (1.0 + MARGIN) * reach * reach
    }

    /// A lower bound of the distance of the triangle from a point: that of the circle around it in
    /// its plane.
    pub(super) fn least_distance(&self, plane: &Plane, point: &Vector3) -> f64 {
        let from_middle = point - self.middle;
        let squared = from_middle.norm_squared();
        let height_squared = from_middle.dot(&plane.normal).powi(2);
        let along = (squared - height_squared).max(0.0).sqrt();
        let aside = (along - self.radius).max(0.0);
        let distance = (height_squared + aside * aside).sqrt();
        // The plane of a thin triangle is NaN, and max takes the other value.
        (distance - MARGIN * (distance + self.radius)).max(0.0)
    }

    /// The largest distance of a point of the triangle from its middle in a direction (a unit
    /// vector); NaN for a thin triangle.
    pub(super) fn most_along(&self, plane: &Plane, direction: &Vector3) -> f64 {
        let across = plane.normal.dot(direction);
        self.radius * (1.0 + MARGIN - across * across).sqrt()
    }
}
