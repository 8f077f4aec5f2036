//! A solid box with sides along the axes of its frame.

use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use serde::Serialize;

use super::touch::{Touch, are_finite};
use dem_io::Bounds;

/// A solid box.
///
/// A feature is sx + 3 sy + 9 sz, where sx is 0 on the side of the smallest x, 2 on that of the
/// largest, 1 between, and so on: a face has one of them that is not 1, an edge two, a corner
/// three.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SolidBox {
    low: [f64; 3],
    high: [f64; 3],
}

/// The feature if the centre is between the sides along all axes.
const MIDDLE: u32 = 13;
const STRIDES: [u32; 3] = [1, 3, 9];
/// Pieces of an edge, between points on the surface.
const PIECES: usize = 8;

impl SolidBox {
    /// The box between its smallest and its largest corner, m; refuses one without an inside.
    pub fn new(low_m: [f64; 3], high_m: [f64; 3]) -> Result<Self> {
        if !are_finite(&low_m) || !are_finite(&high_m) || (0..3).any(|k| low_m[k] >= high_m[k]) {
            return Err(Diagnostic::input(
                "",
                format!("a box from {low_m:?} m to {high_m:?} m has no inside"),
                "give a smallest corner that is below the largest along every axis",
            ));
        }
        Ok(Self {
            low: low_m,
            high: high_m,
        })
    }

    /// The nearest point of its surface.
    pub fn touch(&self, centre: [f64; 3]) -> Touch {
        let mut nearest = centre;
        let mut feature = MIDDLE;
        let mut inward = Vector3::zeros();
        for k in 0..3 {
            if centre[k] < self.low[k] {
                nearest[k] = self.low[k];
                feature -= STRIDES[k];
                inward = Vector3::ith(k, 1.0);
            } else if centre[k] > self.high[k] {
                nearest[k] = self.high[k];
                feature += STRIDES[k];
                inward = Vector3::ith(k, -1.0);
            }
        }
        if feature == MIDDLE {
            return self.touch_from_inside(centre);
        }
        Touch::towards(centre.into(), nearest.into(), inward, feature)
    }

    fn touch_from_inside(&self, centre: [f64; 3]) -> Touch {
        let mut least = f64::INFINITY;
        let mut out = (0, 0.0);
        for (k, x) in centre.into_iter().enumerate() {
            for (depth, sign) in [(x - self.low[k], -1.0), (self.high[k] - x, 1.0)] {
                if depth < least {
                    least = depth;
                    out = (k, sign);
                }
            }
        }
        let (k, sign) = out;
        let outward = Vector3::ith(k, sign);
        let feature = if sign < 0.0 {
            MIDDLE - STRIDES[k]
        } else {
            MIDDLE + STRIDES[k]
        };
        Touch::under(centre.into(), outward, least, feature)
    }

    /// The box itself.
    pub fn bounds(&self) -> Bounds {
        Bounds {
            low: self.low,
            high: self.high,
        }
    }

    /// Its corners, and points on its edges and faces, m.
    pub(super) fn surface_points_m(&self) -> Vec<[f64; 3]> {
        let at = |k: usize, part: usize| {
            let share = part as f64 / PIECES as f64;
            self.low[k] + share * (self.high[k] - self.low[k])
        };
        let stops = PIECES + 1;
        let parts = (0..stops.pow(3)).map(|n| [n % stops, n / stops % stops, n / stops.pow(2)]);
        let is_outside = |parts: &[usize; 3]| parts.iter().any(|part| part % PIECES == 0);
        let outside = parts.filter(is_outside);
        outside
            .map(|parts| [0, 1, 2].map(|k| at(k, parts[k])))
            .collect()
    }
}

/// Whether a feature is a face, not an edge or a corner.
pub(super) fn is_face(feature: u32) -> bool {
    let off_middle = STRIDES.map(|stride| u32::from(feature / stride % 3 != 1));
    off_middle.iter().sum::<u32>() == 1
}
