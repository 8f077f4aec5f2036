//! The spheres of a heap, and the moments of their mass.

use nalgebra::Vector3;

use crate::measure::spheres;

/// A sphere: mass, kg, radius, m, height, and two coordinates across, m.
pub(super) struct Sphere {
    pub(super) mass_kg: f64,
    pub(super) radius_m: f64,
    pub(super) height_m: f64,
    pub(super) across_m: [f64; 2],
}

/// Moments of a heap's mass.
pub(super) struct Moments {
    /// Position of the axis.
    pub(super) middle_m: [f64; 2],
    /// Variance of the height, m2.
    pub(super) upright_m2: f64,
    /// Mean square distance from the axis, m2.
    pub(super) across_m2: f64,
    /// Covariance of height and square distance, m3.
    pub(super) covariance_m3: f64,
}

/// The spheres, along axes of which one points up.
pub(super) fn turned(spheres: &[spheres::Sphere], up: &Vector3<f64>) -> Vec<Sphere> {
    let [aside, across] = spheres::across(up);
    let turned = |sphere: &spheres::Sphere| Sphere {
        mass_kg: sphere.mass_kg,
        radius_m: sphere.radius_m,
        height_m: sphere.place_m.dot(up),
        across_m: [sphere.place_m.dot(&aside), sphere.place_m.dot(&across)],
    };
    spheres.iter().map(turned).collect()
}

/// The moments of some spheres.
pub(super) fn moments(heap: &[Sphere]) -> Moments {
    let mass_kg: f64 = heap.iter().map(|sphere| sphere.mass_kg).sum();
    let mean =
        |of: &dyn Fn(&Sphere) -> f64| heap.iter().map(|s| s.mass_kg * of(s)).sum::<f64>() / mass_kg;
    let middle_m = [0, 1].map(|k| mean(&|s| s.across_m[k]));
    let height_m = mean(&|s| s.height_m);
    let square = |s: &Sphere| {
        let [x, y] = [0, 1].map(|k| s.across_m[k] - middle_m[k]);
        x * x + y * y
    };
    let square_m2 = mean(&square);
    // A solid sphere's own variance along any axis.
    let own_m2 = 0.2 * mean(&|s| s.radius_m * s.radius_m);
    Moments {
        middle_m,
        upright_m2: own_m2 + mean(&|s| (s.height_m - height_m).powi(2)),
        across_m2: 2.0 * own_m2 + square_m2,
        covariance_m3: mean(&|s| (s.height_m - height_m) * (square(s) - square_m2)),
    }
}
