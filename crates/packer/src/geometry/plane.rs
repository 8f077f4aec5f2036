//! The planes of triangles, and what surrounds them.

use super::tree::Corners;
use crate::spheres::Vector3;

/// A triangle and the plane in which it lies: p is above it where u = (p - corner) . along_u >= 0,
/// v >= 0 and u + v <= 1.
pub(super) struct Plane {
    /// The first corner.
    pub(super) corner: Vector3,
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
    #[inline]
    pub(super) fn new(corners: Corners) -> Self {
        let [a, b, c] = corners.map(Vector3::from);
        let (edge_u, edge_v) = (b - a, c - a);
        let normal = edge_u.cross(&edge_v);
        let edges = [edge_u, edge_v, c - b].map(|edge| edge.norm_squared());
        let longest_squared = edges.into_iter().fold(0.0, f64::max);
        // The normal of a thin triangle is inaccurate, and hardly any points are above the
        // triangle. With NaN every comparison fails.
        let squared = normal.norm_squared();
        let squared = if squared < (THINNEST * longest_squared).powi(2) {
            f64::NAN
        } else {
            squared
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
    fn height_over_triangle(&self, point: &Vector3) -> Option<f64> {
        let from_corner = point - self.corner;
        let [u, v] = self.along_triangle(&from_corner);
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| from_corner.dot(&self.normal))
    }
}

/// Distance of a point from the plane of a triangle, positive on the side of the normal, with that
/// normal, if it is above or below the triangle.
#[inline]
pub(super) fn height_over(corners: Corners, point: &Vector3) -> Option<(f64, Vector3)> {
    // Most points are beside a triangle, which needs no division. The other test is as exact as
    // this margin up to a thousand edges away.
    const CERTAIN: f64 = 1e-6;
    let [a, b, c] = corners.map(Vector3::from);
    let (edge_u, edge_v, from_corner) = (b - a, c - a, point - a);
    let normal = edge_u.cross(&edge_v);
    let squared = normal.norm_squared();
    let u = from_corner.dot(&edge_v.cross(&normal));
    let v = from_corner.dot(&normal.cross(&edge_u));
    let margin = CERTAIN * squared;
    if u < -margin || v < -margin || u + v > squared + margin {
        return None;
    }
    let plane = Plane::new(corners);
    Some((plane.height_over_triangle(point)?, plane.normal))
}

/// The flat cylinder around a triangle, in single precision: 32 bytes side by side, by which many
/// are excluded without their corners.
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

    /// True if the triangle is certainly farther from a point than `distance` in a direction (a
    /// unit vector).
    #[inline(always)]
    pub(super) fn is_past(&self, point: &Vector3, direction: &Vector3, distance: f64) -> bool {
        let (radius, half_height) = (f64::from(self.radius), f64::from(self.half_height));
        let middle = direction.dot(&(self.middle() - point));
        let beyond = middle - half_height - distance;
        // How far the disc around the middle reaches back, squared.
        let along_normal = self.normal().dot(direction);
        let reach_squared = radius * radius * (1.0 + MARGIN - along_normal * along_normal);
        (beyond > 0.0) & (beyond * beyond > reach_squared)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector() -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-1.0..1.0).prop_map(Vector3::from)
    }

    /// Triangles, half of them thin.
    fn triangle() -> impl Strategy<Value = Corners> {
        let octaves = prop_oneof![-2.0_f64..0.0, -30.0_f64..0.0];
        (vector(), vector(), vector(), octaves).prop_map(|(a, along, aside, octaves)| {
            [a, a + along, a + 0.5 * along + octaves.exp2() * aside].map(Into::into)
        })
    }

    /// u or v: beside the triangle, above it, or at an edge.
    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), Just(1.0), -0.5..1.5, 0.0..0.5]
    }

    /// A small shift to either side, from rounding to more than the margin of the quick test.
    fn little() -> impl Strategy<Value = f64> {
        (prop_oneof![Just(-1.0), Just(0.0), Just(1.0)], -17.0..-5.0)
            .prop_map(|(sign, digits)| sign * 10.0_f64.powf(digits))
    }

    proptest! {
        #[test]
        fn what_is_past_is_past_with_all_corners(
            corners in triangle(), point in vector(), direction in vector(), distance in 0.0..1.0,
        ) {
            let direction = direction.normalize();
            let around = Surroundings::new(corners);
            let heights = corners.map(|corner| direction.dot(&(Vector3::from(corner) - point)));
            let is_past = around.is_past(&point, &direction, distance);
            prop_assert!(!is_past || heights.iter().all(|height| *height >= distance));
            // The flat cylinder reaches no farther back than the ball around the triangle.
            let middle = heights.iter().sum::<f64>() / 3.0;
            let reach = 1.000_01 * f64::from(around.radius) + f64::from(around.half_height);
            prop_assert!(is_past || middle <= distance + reach);
        }

        #[test]
        fn a_flat_triangle_is_past_where_its_plane_is(
            corners in triangle(), height in 0.01..1.0,
        ) {
            let around = Surroundings::new(corners);
            let normal = around.normal();
            prop_assume!(normal.norm() > 0.5);
            let direction = normal.normalize();
            let point = around.middle() - height * direction;
            prop_assert!(around.is_past(&point, &direction, height - 0.005));
            prop_assert!(!around.is_past(&point, &direction, height + 1e-6));
        }

        #[test]
        fn the_height_is_that_over_the_plane_or_there_is_none(
            corners in triangle(), mut u in coordinate(), v in coordinate(), at_edge: bool,
            height in -1.0..1.0, [du, dv] in [little(), little()],
        ) {
            if at_edge {
                u = 1.0 - v;
            }
            let [a, b, c] = corners.map(Vector3::from);
            let plane = Plane::new(corners);
            let normal = if plane.normal.x.is_nan() { Vector3::x() } else { plane.normal };
            let point = a + (u + du) * (b - a) + (v + dv) * (c - a) + height * normal;
            let found = height_over(corners, &point);
            prop_assert_eq!(found.map(|(height, _)| height), plane.height_over_triangle(&point));
            prop_assert!(found.is_none_or(|(_, normal)| normal == plane.normal));
            let is_above = u > 0.01 && v > 0.01 && u + v < 0.99 && plane.normal == normal;
            prop_assert!(found.is_some() || !is_above);
        }
    }
}
