//! Triangles as planes: prepared for the point nearest to another.

use super::tree::Corners;
use crate::spheres::Vector3;
use std::hint::black_box;

/// A triangle and the plane in which it lies: p is above it where u = (p - corner) . along_u >= 0,
/// v >= 0 and u + v <= 1.
pub(super) struct Plane {
    pub(super) corners: Corners,
    pub(super) normal: Vector3,
    along_u: Vector3,
    along_v: Vector3,
}

/// Triangles whose height is a smaller fraction of their longest edge have no plane: its normal
/// would have an error of more than 1e-10.
const THINNEST: f64 = 1e-6;
/// Relative margin when distances are compared with those from numbers in single precision.
const MARGIN: f64 = 1e-6;

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
            corners,
            normal: normal / squared.sqrt(),
            along_u: edge_v.cross(&normal) / squared,
            along_v: normal.cross(&edge_u) / squared,
        }
    }

    /// Reads from its parts, so that its cache lines are fetched.
    #[inline(always)]
    pub(super) fn fetch(&self) {
        black_box(self.corners[0][0]);
        black_box(self.normal.x);
        black_box(self.along_v.z);
    }

    /// The first corner.
    pub(super) fn corner(&self) -> Vector3 {
        self.corners[0].into()
    }

    /// u and v of a point given relative to the corner.
    pub(super) fn along_triangle(&self, from_corner: &Vector3) -> [f64; 2] {
        [&self.along_u, &self.along_v].map(|along| from_corner.dot(along))
    }

    /// Distance of a point from the plane, positive on the side of the normal, if it is above or
    /// below the triangle.
    pub(super) fn height_over_triangle(&self, point: &Vector3) -> Option<f64> {
        let from_corner = point - self.corner();
        let [u, v] = self.along_triangle(&from_corner);
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| from_corner.dot(&self.normal))
    }
}

/// The flat cylinder around a triangle, in single precision: by far the smallest part of what is
/// known about it, so that many are excluded without reading the rest.
#[derive(Clone, Copy)]
pub(super) struct Surroundings {
    pub(super) middle: [f32; 3],
    pub(super) radius: f32,
    /// Direction of the axis. Zero for a triangle without area: the cylinder is a ball then.
    pub(super) normal: [f32; 3],
    pub(super) half_height: f32,
}

impl Surroundings {
    pub(super) fn new(corners: Corners) -> Self {
        let [a, b, c] = corners.map(Vector3::from);
        let single = |v: Vector3| [v.x, v.y, v.z].map(|x| x as f32);
        let normal = (b - a).cross(&(c - a));
        let mut around = Self {
            middle: single((a + b + c) / 3.0),
            radius: 0.0,
            normal: single(normal / normal.norm().max(f64::MIN_POSITIVE)),
            half_height: 0.0,
        };
        for corner in [a, b, c] {
            let from_middle = corner - around.middle();
            let height = from_middle.dot(&around.normal()).abs();
            around.radius = around.radius.max((from_middle.norm() as f32).next_up());
            around.half_height = around.half_height.max((height as f32).next_up());
        }
        around
    }

    #[inline(always)]
    pub(super) fn middle(&self) -> Vector3 {
        let [x, y, z] = self.middle;
        Vector3::new(x.into(), y.into(), z.into())
    }

    #[inline(always)]
    fn normal(&self) -> Vector3 {
        let [x, y, z] = self.normal;
        Vector3::new(x.into(), y.into(), z.into())
    }

    /// True if the triangle is certainly farther from a point than `reach`.
    #[inline(always)]
    pub(super) fn is_beyond(&self, point: &Vector3, reach: f64) -> bool {
        let reach = reach + f64::from(self.radius);
        (point - self.middle()).norm_squared() > (1.0 + MARGIN) * reach * reach
    }

    /// A lower bound of the distance of the triangle from a point: that of the cylinder.
    #[inline(always)]
    pub(super) fn least_distance(&self, point: &Vector3) -> f64 {
        let (radius, half_height) = (f64::from(self.radius), f64::from(self.half_height));
        let from_middle = point - self.middle();
        let squared = from_middle.norm_squared();
        let height = from_middle.dot(&self.normal());
        let along = (squared - height * height).max(0.0).sqrt();
        let aside = (along - radius).max(0.0);
        let above = (height.abs() - half_height).max(0.0);
        let distance = (above * above + aside * aside).sqrt();
        (distance - MARGIN * (distance + radius)).max(0.0)
    }

    /// The largest distance of a point of the triangle from the middle in a direction (a unit
    /// vector), or more.
    #[inline(always)]
    pub(super) fn most_along(&self, direction: &Vector3) -> f64 {
        let (radius, half_height) = (f64::from(self.radius), f64::from(self.half_height));
        let along_normal = self.normal().dot(direction);
        radius * (1.0 + MARGIN - along_normal * along_normal).sqrt() + half_height
    }
}
