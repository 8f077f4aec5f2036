//! A solid sphere.

use std::f64::consts::{PI, TAU};

use dem_io::{Bounds, Diagnostic, Result};
use nalgebra::Vector3;
use serde::Serialize;

use super::patches::{Divided, Patch, Patches, part, parts, refuse_many};
use super::touch::{Touch, are_finite};

/// A solid sphere. Its only feature is 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sphere {
    centre: Vector3<f64>,
    radius_m: f64,
}

/// Rings and turns of triangles and points on the surface.
const RINGS: u32 = 24;
const TURNS: u32 = 48;

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

    /// Its centre, m. Length 3.
    pub fn centre_m(&self) -> [f64; 3] {
        self.centre.into()
    }

    /// Its radius, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
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

    /// Points on its surface, m.
    pub(super) fn surface_points_m(&self) -> Vec<[f64; 3]> {
        let rings = (0..=RINGS).flat_map(|ring| (0..TURNS).map(move |turn| [ring, turn]));
        let shares = rings.map(|[ring, turn]| {
            let [ring, rings, turn, turns] = [ring, RINGS, turn, TURNS].map(f64::from);
            [turn / turns, ring / rings]
        });
        shares
            .map(|[turn, ring]| self.surface_point_m(turn, ring).into())
            .collect()
    }

    /// Vertices, m, and triangles of a surface that looks like it.
    pub fn triangles(&self) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let cells = (0..RINGS).flat_map(|ring| (0..TURNS).map(move |turn| (ring, turn)));
        let triangles = cells.flat_map(|(ring, turn)| {
            let [a, b] = [turn, (turn + 1) % TURNS].map(|turn| ring * TURNS + turn);
            [[a, a + TURNS, b + TURNS], [a, b + TURNS, b]]
        });
        (self.surface_points_m(), triangles.collect())
    }

    /// Unit vector at a share of the turn about z and of the way from the upper to the lower pole.
    fn outward(turn: f64, ring: f64) -> Vector3<f64> {
        let ((sin, cos), (y, x)) = ((PI * ring).sin_cos(), (TAU * turn).sin_cos());
        Vector3::new(sin * x, sin * y, cos)
    }

    fn surface_point_m(&self, turn: f64, ring: f64) -> Vector3<f64> {
        self.centre + self.radius_m * Self::outward(turn, ring)
    }
}

/// Patches by turn about z and by ring from the upper to the lower pole.
impl Divided for Sphere {
    fn patches(&self, edge_m: f64) -> Result<Patches> {
        let around = parts(TAU * self.radius_m, edge_m).max(12.0);
        let rings = parts(PI * self.radius_m, edge_m).max(6.0);
        refuse_many(edge_m, around * rings)?;
        Ok(Patches::of_counts([around, rings, 0.0]))
    }

    fn count(&self, patches: &Patches) -> Option<u64> {
        let [around, rings, _] = patches.counts;
        Some(around * rings)
    }

    fn at(&self, patches: &Patches, point_m: [f64; 3], _inward: [f64; 3]) -> u64 {
        let [around, rings, _] = patches.counts;
        let from = Vector3::from(point_m) - self.centre;
        let turn = from.y.atan2(from.x).rem_euclid(TAU) / TAU;
        let ring = from.xy().norm().atan2(from.z) / PI;
        part(ring, rings) * around + part(turn, around)
    }

    fn patch(&self, patches: &Patches, number: u64) -> Patch {
        let [around, rings, _] = patches.counts;
        let [i, j] = [(number % around) as f64, (number / around) as f64];
        let [around, rings] = [around as f64, rings as f64];
        let corners = [[i, j], [i, j + 1.0], [i + 1.0, j + 1.0], [i + 1.0, j]];
        // Those at a pole are one.
        let is_one = |corner: &[f64; 2]| corner[0] == i || (corner[1] > 0.0 && corner[1] < rings);
        let corners = corners.into_iter().filter(is_one);
        let cosines = [j, j + 1.0].map(|ring| (PI * ring / rings).cos());
        let middle = [(i + 0.5) / around, (j + 0.5) / rings];
        Patch {
            centre_m: self.surface_point_m(middle[0], middle[1]).into(),
            normal: Self::outward(middle[0], middle[1]).into(),
            area_m2: TAU * self.radius_m.powi(2) * (cosines[0] - cosines[1]) / around,
            corners_m: corners
                .map(|[i, j]| self.surface_point_m(i / around, j / rings).into())
                .collect(),
        }
    }
}
