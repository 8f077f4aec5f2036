//! Mass properties of a rigid body made of spheres.

use dem_io::body::inertia::of_moments;
pub use dem_io::body::inertia::{MassProperties, of_spheres};
use nalgebra::Vector3;

use super::union;

/// The mass properties of the union of spheres of one density: each overlap counts once.
///
/// `centres_m` and `radii_m`, m, have one entry per sphere; entries without a counterpart are
/// ignored. The density is in kg/m^3. Voids between spheres stay empty.
///
/// All integrals have closed forms on the arcs of circles that bound the free part of each sphere.
/// A union without volume has no mass and zero moments.
pub fn of_union(centres_m: &[[f64; 3]], radii_m: &[f64], density_kg_m3: f64) -> MassProperties {
    let count = centres_m.len().min(radii_m.len());
    let Some(&origin) = centres_m.first().filter(|_| count > 0) else {
        return of_moments([0.0; 3], 0.0, [[0.0; 3]; 3]);
    };
    let origin = Vector3::from(origin);
    let offsets = || {
        centres_m[..count]
            .iter()
            .map(|c| Vector3::from(*c) - origin)
    };
    let mean = offsets().sum::<Vector3<f64>>() / count as f64;
    let centred: Vec<[f64; 3]> = offsets().map(|v| (v - mean).into()).collect();
    let solid = union::solid(&centred, &radii_m[..count]);
    if solid.volume.is_nan() || solid.volume <= 0.0 {
        return of_moments((origin + mean).into(), 0.0, [[0.0; 3]; 3]);
    }
    let centre = solid.first / solid.volume;
    let second = solid.second - centre * solid.first.transpose();
    of_moments(
        (origin + (mean + centre)).into(),
        density_kg_m3 * solid.volume,
        (second * density_kg_m3).into(),
    )
}
