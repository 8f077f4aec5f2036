//! A solid cylinder with flat ends.

use std::f64::consts::TAU;

use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use serde::Serialize;

use super::touch::{Touch, are_finite};
use dem_io::Bounds;

/// A solid cylinder. Features: 0 the lateral surface, 1 and 2 the first and the second end, 3 and 4
/// their rims.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Cylinder {
    start: Vector3<f64>,
    /// Unit vector from the first to the second end.
    axis: Vector3<f64>,
    length_m: f64,
    radius_m: f64,
}

const SIDE: u32 = 0;
const ENDS: [u32; 2] = [1, 2];
const RIMS: [u32; 2] = [3, 4];
/// Rings of points along it, less one, and points on each of them.
const RINGS: usize = 16;
const ROUND: usize = 16;

impl Cylinder {
    /// The cylinder between the middles of its two ends, m; refuses one without an inside.
    pub fn new(ends_m: [[f64; 3]; 2], radius_m: f64) -> Result<Self> {
        let [start, end] = ends_m.map(Vector3::from);
        let length_m = (end - start).norm();
        let is_solid = length_m > 0.0 && radius_m > 0.0;
        if !is_solid || !are_finite(ends_m.as_flattened()) || !are_finite(&[length_m, radius_m]) {
            return Err(Diagnostic::input(
                "",
                format!(
                    "a cylinder from {:?} m to {:?} m with a radius of {radius_m} m has no inside",
                    ends_m[0], ends_m[1]
                ),
                "give two different ends and a positive radius",
            ));
        }
        Ok(Self {
            start,
            axis: (end - start) / length_m,
            length_m,
            radius_m,
        })
    }

    /// The nearest point of its surface.
    pub fn touch(&self, centre: [f64; 3]) -> Touch {
        let c = Vector3::from(centre);
        let from_start = c - self.start;
        let along = from_start.dot(&self.axis);
        let across = from_start - along * self.axis;
        let off_axis = across.norm();
        let radial = if off_axis > 0.0 {
            across / off_axis
        } else {
            self.any_radial()
        };
        let is_beside = off_axis > self.radius_m;
        let beyond = if along < 0.0 {
            Some(0)
        } else if along > self.length_m {
            Some(1)
        } else {
            None
        };
        let (feature, inward) = match (beyond, is_beside) {
            (None, false) => return self.touch_from_inside(c, along, off_axis, radial),
            (None, true) => (SIDE, -radial),
            (Some(end), false) => (ENDS[end], [self.axis, -self.axis][end]),
            (Some(end), true) => (RIMS[end], -radial),
        };
        let point = self.start
            + along.clamp(0.0, self.length_m) * self.axis
            + off_axis.min(self.radius_m) * radial;
        Touch::towards(c, point, inward, feature)
    }

    fn touch_from_inside(
        &self,
        c: Vector3<f64>,
        along: f64,
        off_axis: f64,
        radial: Vector3<f64>,
    ) -> Touch {
        let mut best = (self.radius_m - off_axis, radial, SIDE);
        for out in [
            (along, -self.axis, ENDS[0]),
            (self.length_m - along, self.axis, ENDS[1]),
        ] {
            if out.0 < best.0 {
                best = out;
            }
        }
        let (depth_m, outward, feature) = best;
        Touch::under(c, outward, depth_m, feature)
    }

    /// A unit vector perpendicular to the axis, for centres on it.
    fn any_radial(&self) -> Vector3<f64> {
        self.axis
            .cross(&Vector3::ith(self.axis.iamin(), 1.0))
            .normalize()
    }

    /// The middles of its two ends, m. Shape 2 x 3.
    pub fn ends_m(&self) -> [[f64; 3]; 2] {
        [self.start, self.start + self.length_m * self.axis].map(Into::into)
    }

    /// Radius, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        let end = self.start + self.length_m * self.axis;
        let half = self
            .axis
            .map(|a| self.radius_m * (1.0 - a * a).max(0.0).sqrt());
        let points = [self.start - half, self.start + half, end - half, end + half];
        Bounds::of(points)
    }

    /// Points on its side and rims, and the middles of its ends, m.
    pub(super) fn surface_points_m(&self) -> Vec<[f64; 3]> {
        let [from, to] = self.ends_m().map(Vector3::from);
        let along = to - from;
        let across = along.cross(&Vector3::ith(along.iamin(), 1.0)).normalize();
        let other = along.normalize().cross(&across);
        let rings = (0..=RINGS).flat_map(|ring| {
            let centre = from + ring as f64 / RINGS as f64 * along;
            (0..ROUND).map(move |k| {
                let (sine, cosine) = (TAU * k as f64 / ROUND as f64).sin_cos();
                centre + self.radius_m * (cosine * across + sine * other)
            })
        });
        rings.chain([from, to]).map(Into::into).collect()
    }
}

/// Whether a feature is one of the flat ends.
pub(super) fn is_end(feature: u32) -> bool {
    ENDS.contains(&feature)
}
