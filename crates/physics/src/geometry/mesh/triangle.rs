//! The nearest point of a triangle.

use nalgebra::Vector3;
use serde::Serialize;

use crate::geometry::touch::Touch;

/// Regions of a triangle: 0 its face; 1, 2, 3 the edges from its first, second, third corner; 4, 5,
/// 6 its corners.
pub(super) const REGIONS: u32 = 7;

/// A triangle with its normal.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub(super) struct Triangle {
    pub(super) corners: [Vector3<f64>; 3],
    /// Unit vector; the corners run counter-clockwise around it.
    pub(super) normal: Vector3<f64>,
}

impl Triangle {
    /// Requires corners that are not on one line.
    pub(super) fn new(corners: [Vector3<f64>; 3]) -> Self {
        let [a, b, c] = corners;
        Self {
            corners,
            normal: (b - a).cross(&(c - a)).normalize(),
        }
    }

    /// The point nearest to `p`, and its region (Ericson 2005, section 5.1.5).
    pub(super) fn nearest(&self, p: &Vector3<f64>) -> (Vector3<f64>, u32) {
        let [a, b, c] = &self.corners;
        let (ab, ac) = (b - a, c - a);
        let from_a = p - a;
        let (d1, d2) = (ab.dot(&from_a), ac.dot(&from_a));
        if d1 <= 0.0 && d2 <= 0.0 {
            return (*a, 4);
        }
        let from_b = p - b;
        let (d3, d4) = (ab.dot(&from_b), ac.dot(&from_b));
        if d3 >= 0.0 && d4 <= d3 {
            return (*b, 5);
        }
        if d1 * d4 - d3 * d2 <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return (a + d1 / (d1 - d3) * ab, 1);
        }
        let from_c = p - c;
        let (d5, d6) = (ab.dot(&from_c), ac.dot(&from_c));
        if d6 >= 0.0 && d5 <= d6 {
            return (*c, 6);
        }
        if d5 * d2 - d1 * d6 <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return (a + d2 / (d2 - d6) * ac, 3);
        }
        let (to_c, to_b) = (d4 - d3, d5 - d6);
        if d3 * d6 - d5 * d4 <= 0.0 && to_c >= 0.0 && to_b >= 0.0 {
            return (b + to_c / (to_c + to_b) * (c - b), 2);
        }
        (p - from_a.dot(&self.normal) * self.normal, 0)
    }

    /// Touch at the foot of `c` on its plane.
    pub(super) fn over(&self, c: &Vector3<f64>, feature: u32) -> Touch {
        let height = (c - self.corners[0]).dot(&self.normal);
        let inward = -self.normal * 1.0_f64.copysign(height);
        Touch {
            point: (c + height.abs() * inward).into(),
            normal: inward.into(),
            distance_m: height.abs(),
            feature,
        }
    }

    /// Whether `p` lies on it, within a distance.
    pub(super) fn holds(&self, p: &Vector3<f64>, within: f64) -> bool {
        (p - self.corners[0]).dot(&self.normal).abs() <= within
            && (self.nearest(p).0 - p).norm_squared() <= within * within
    }
}
