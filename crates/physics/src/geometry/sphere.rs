//! A solid sphere.

use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use serde::Serialize;

use super::touch::{Touch, are_finite};
use dem_io::Bounds;

/// A solid sphere. Its only feature is 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sphere {
    centre: Vector3<f64>,
    radius_m: f64,
}

impl Sphere {
    /// The sphere around a point, m; refuses one without an inside.
    pub fn new(centre_m: [f64; 3], radius_m: f64) -> Result<Self> {
        if !(are_finite(&centre_m) && radius_m > 0.0 && radius_m.is_finite()) {
            return Err(Diagnostic::input(
                "",
                format!(
                    "a sphere around {centre_m:?} m with a radius of {radius_m} m has no inside"
                ),
                "give a positive radius",
            ));
        }
        Ok(Self {
            centre: Vector3::from(centre_m),
            radius_m,
        })
    }

    /// The nearest point of its surface.
    pub fn touch(&self, centre: [f64; 3]) -> Touch {
        let c = Vector3::from(centre);
        let out = c - self.centre;
        let outward = out.try_normalize(0.0).unwrap_or_else(Vector3::z);
        Touch::under(c, outward, self.radius_m - out.norm(), 0)
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        let half = Vector3::repeat(self.radius_m);
        Bounds::of([self.centre - half, self.centre + half])
    }

    /// Vertices, m, and triangles of a surface that looks like it.
    pub fn triangles(&self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let mut vertices = Vec::new();
        let mut triangles = Vec::new();
        for (ring, turn) in (0..=RINGS).flat_map(|ring| (0..TURNS).map(move |turn| (ring, turn))) {
            let (sin, cos) = (std::f64::consts::PI * f64::from(ring) / f64::from(RINGS)).sin_cos();
            let (y, x) = (std::f64::consts::TAU * f64::from(turn) / f64::from(TURNS)).sin_cos();
            let out = Vector3::new(sin * x, sin * y, cos);
            vertices.push((self.centre + self.radius_m * out).into());
            if ring < RINGS {
                let [a, b] = [turn, (turn + 1) % TURNS].map(|turn| ring * TURNS + turn);
                triangles.extend([[a, a + TURNS, b + TURNS], [a, b + TURNS, b]]);
            }
        }
        (vertices, triangles)
    }
}

/// Rings and turns of the triangles.
const RINGS: u32 = 24;
const TURNS: u32 = 48;
