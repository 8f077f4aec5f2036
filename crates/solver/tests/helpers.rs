//! Helpers for several subjects: scenes from texts, their bodies, and random numbers.

use dem_io::Body;
use dem_scene::Scene;
use dem_scene::scene_from_text;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// The scene of a valid text.
pub(crate) fn scene(text: &str) -> Scene {
    scene_from_text(text, "test.toml", &[]).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Pseudo-random numbers (SplitMix64).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Between two bounds.
    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// In a cube around the origin.
    pub(crate) fn point(&mut self, half: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(-half, half))
    }

    /// On the unit sphere.
    pub(crate) fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = Vector3::from(self.point(1.0));
            if v.norm() > 0.1 && v.norm() < 1.0 {
                return v.normalize();
            }
        }
    }

    pub(crate) fn rotation(&mut self) -> UnitQuaternion<f64> {
        loop {
            let q = [0; 4].map(|_| self.within(-1.0, 1.0));
            let q = Quaternion::new(q[0], q[1], q[2], q[3]);
            if q.norm() > 0.1 && q.norm() < 1.0 {
                return UnitQuaternion::new_normalize(q);
            }
        }
    }
}

/// Mass of the parts of the spheres of a body in a box, given by its corners, kg: counted by cubes
/// of a fortieth of each sphere's diameter.
pub(crate) fn mass_in_box_kg(body: &Body, density_kg_m3: f64, [low, high]: [[f64; 3]; 2]) -> f64 {
    mass_within_kg(body, density_kg_m3, |p| {
        (0..3).all(|k| (low[k]..high[k]).contains(&p[k]))
    })
}

/// The same for the points at which `is_in` is true.
pub(crate) fn mass_within_kg(
    body: &Body,
    density_kg_m3: f64,
    is_in: impl Fn([f64; 3]) -> bool,
) -> f64 {
    const STEPS: i32 = 40;
    let middle = |i: i32| (f64::from(2 * i + 1) / f64::from(STEPS)) - 1.0;
    let mut cubes = Vec::new();
    for i in 0..STEPS.pow(3) {
        let p = [i % STEPS, i / STEPS % STEPS, i / STEPS / STEPS].map(middle);
        if p.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
            cubes.push(p);
        }
    }
    let part = |centre: &[f64; 3], radius: f64| {
        let place = |p: &[f64; 3]| [0, 1, 2].map(|k| centre[k] + radius * p[k]);
        cubes.iter().filter(|p| is_in(place(p))).count() as f64 / cubes.len() as f64
    };
    let spheres = body.positions.iter().zip(&body.radii);
    let masses = spheres
        .map(|(p, &r)| part(p, r) * density_kg_m3 * 4.0 / 3.0 * std::f64::consts::PI * r.powi(3));
    masses.sum()
}
