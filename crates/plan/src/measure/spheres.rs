//! The spheres of a set, those within clumps included.

use nalgebra::Vector3;

use super::members::Members;
use dem_engine::state::State;

/// A sphere with its mass.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    pub(super) mass_kg: f64,
    pub(super) radius_m: f64,
    pub(super) place_m: Vector3<f64>,
    /// Number of the piece that it belongs to: spheres of one fragment or clump have the same.
    pub(super) piece: u32,
}

/// Two directions across another and across each other, all of length 1.
pub(super) fn across(up: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let aside = up.cross(&Vector3::ith(up.iamin(), 1.0)).normalize();
    [aside, up.cross(&aside)]
}

/// All spheres of a set. Those of clumps have the masses that they have as particles.
pub(super) fn spheres(members: &Members, state: &State) -> Vec<Sphere> {
    let p = &state.particles;
    // Without clusters nothing can break or touch, and each particle is one.
    let piece_of = |i: usize| {
        let clusters = state.clusters.as_ref();
        clusters.map_or(i as u32, |clusters| clusters.of_particle[i])
    };
    let free = members.free(state).map(|i| Sphere {
        mass_kg: 1.0 / p.motions[i].inverse_mass,
        radius_m: p.poses[i].radius_m(),
        place_m: p.poses[i].place(),
        piece: piece_of(i),
    });
    let clumps = members.clumps(state, &state.clumps.all);
    let carried = clumps.flat_map(|(clump, template)| {
        let piece = piece_of(clump.first as usize);
        (0..template.spheres.len()).map(move |n| {
            let pose = template.pose(n, clump);
            Sphere {
                mass_kg: template.spheres[n].mass_kg,
                radius_m: pose.radius_m(),
                place_m: pose.place(),
                piece,
            }
        })
    });
    free.chain(carried).collect()
}
