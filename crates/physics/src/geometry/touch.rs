//! Points where spheres may touch walls.

use nalgebra::Vector3;

/// A point where a sphere may touch a wall. `point = centre + distance_m * normal`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Nearest point of the wall's surface, m. Length 3.
    pub point: [f64; 3],
    /// Unit vector into the wall: from the centre towards the point, or away from it if the centre
    /// is inside a solid. Length 3.
    pub normal: [f64; 3],
    /// From the centre to the point, m; negative if the centre is inside a solid.
    pub distance_m: f64,
    /// Flat part, straight edge, corner, ... of the wall: stays the same while a sphere slides over
    /// it. The numbering depends on the shape.
    pub feature: u32,
}

/// Points nearer than this coincide: its square does not underflow.
const SMALLEST_M: f64 = 1e-100;

impl Touch {
    /// Touch from the centre `c` to the `point`; with the normal `otherwise` if they coincide.
    pub(super) fn towards(
        c: Vector3<f64>,
        point: Vector3<f64>,
        otherwise: Vector3<f64>,
        feature: u32,
    ) -> Self {
        let apart = point - c;
        let distance_m = apart.norm();
        let normal = if distance_m > SMALLEST_M {
            apart / distance_m
        } else {
            otherwise
        };
        Self {
            point: point.into(),
            normal: normal.into(),
            distance_m,
            feature,
        }
    }

    /// Touch for a centre `c` on or under the surface, whose normal out of the wall is `outward`.
    pub(super) fn under(
        c: Vector3<f64>,
        outward: Vector3<f64>,
        depth_m: f64,
        feature: u32,
    ) -> Self {
        Self {
            point: (c + depth_m * outward).into(),
            normal: (-outward).into(),
            distance_m: -depth_m,
            feature,
        }
    }
}

pub(super) fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|x| x.is_finite())
}
