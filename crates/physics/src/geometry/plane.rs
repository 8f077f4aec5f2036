//! A plane with solid wall behind it.

use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use serde::Serialize;

use super::touch::{Touch, are_finite};
use dem_io::Bounds;

/// The half-space behind a plane. Its only feature is 0.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Plane {
    point: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Plane {
    /// The plane through a point, m, with a normal out of the wall, of any length but zero.
    pub fn new(point_m: [f64; 3], normal: [f64; 3]) -> Result<Self> {
        let length = Vector3::from(normal).norm();
        if !(are_finite(&point_m) && length > 0.0 && length.is_finite()) {
            return Err(Diagnostic::input(
                "",
                format!("a plane through {point_m:?} with the normal {normal:?} has no place"),
                "give finite numbers and a normal that is not zero",
            ));
        }
        Ok(Self {
            point: Vector3::from(point_m),
            normal: Vector3::from(normal) / length,
        })
    }

    /// The nearest point of the plane.
    pub fn touch(&self, centre: [f64; 3]) -> Touch {
        let c = Vector3::from(centre);
        let height = (c - self.point).dot(&self.normal);
        Touch::under(c, self.normal, -height, 0)
    }

    /// A point of it, m. Length 3.
    pub fn point_m(&self) -> [f64; 3] {
        self.point.into()
    }

    /// Unit vector out of the wall. Length 3.
    pub fn normal(&self) -> [f64; 3] {
        self.normal.into()
    }

    /// All of space: a plane is infinite.
    pub fn bounds(&self) -> Bounds {
        Bounds {
            low: [f64::NEG_INFINITY; 3],
            high: [f64::INFINITY; 3],
        }
    }
}
