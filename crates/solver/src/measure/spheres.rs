//! The spheres of a set, those within clumps included.

use nalgebra::Vector3;

use super::members::Members;
use crate::state::State;

/// A sphere with its mass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    /// kg.
    pub(super) mass_kg: f64,
    /// m.
    pub(super) radius_m: f64,
    /// m.
    pub(super) place_m: Vector3<f64>,
}

/// Two directions across another and across each other, all of length 1.
pub(super) fn across(up: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let aside = up.cross(&Vector3::ith(up.iamin(), 1.0)).normalize();
    [aside, up.cross(&aside)]
}

/// All spheres of a set. Those of clumps have the masses that they have as particles.
pub(super) fn spheres(members: &Members, state: &State) -> Vec<Sphere> {
    let p = &state.particles;
    let free = members.free(state).map(|i| Sphere {
        mass_kg: 1.0 / p.motions[i].inverse_mass,
        radius_m: p.poses[i].radius_m(),
        place_m: p.poses[i].place(),
    });
    let clumps = members.clumps(state, &state.clumps.all);
    let carried = clumps.flat_map(|(clump, template)| {
        (0..template.spheres.len()).map(move |n| {
            let pose = template.pose(n, clump);
            Sphere {
                mass_kg: template.spheres[n].mass_kg,
                radius_m: pose.radius_m(),
                place_m: pose.place(),
            }
        })
    });
    free.chain(carried).collect()
}
