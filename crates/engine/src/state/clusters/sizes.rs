//! Sizes of fragments: the box around them, and the sieve opening that they pass.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::detection::Clusters;
use crate::state::clumps::Clumps;
use crate::state::particles::Particles;
use dem_physics::rotation::rotation;
use dem_physics::shape::inertia::of_spheres;
use dem_physics::shape::sieve::{Ball, smallest_opening_m};

/// Mass and size of a fragment.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct FragmentSize {
    /// Its body: number in [`crate::state::model::Model::bodies`].
    pub body: u32,
    /// kg.
    pub mass_kg: f64,
    /// Diameter of the sphere with the volume of its particles, where overlaps count twice, m.
    pub equivalent_diameter_m: f64,
    /// Lengths of the box around its spheres along its principal axes of inertia, the longest
    /// first, m. Length 3.
    pub box_lengths_m: [f64; 3],
    /// Side of the smallest square opening that it passes, m: see [`sieve_m`].
    pub sieve_m: f64,
}

/// A fragment or a body that has left through an outlet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Discharged {
    /// s.
    pub time_s: f64,
    /// Its number in [`Clusters::history`].
    pub fragment_id: u32,
    /// The outlet: number among the outlets of the scene, in the order of their names.
    pub outlet: u32,
    /// Its mass and size.
    pub size: FragmentSize,
}

/// Mass and size of a present cluster, whether it is a clump or not.
pub fn size_of(
    id: u32,
    clusters: &Clusters,
    particles: &Particles,
    clumps: &Clumps,
) -> FragmentSize {
    let (spheres, mass_kg) = spheres_of(id, clusters, particles, clumps);
    let cubes: f64 = spheres.iter().map(|s| s.radius_m.powi(3)).sum();
    FragmentSize {
        body: clusters.history[id as usize].body,
        mass_kg,
        equivalent_diameter_m: 2.0 * cubes.cbrt(),
        box_lengths_m: box_lengths_m(&spheres),
        sieve_m: sieve_m(&spheres),
    }
}

/// Mass of a present cluster, whether it is a clump or not, kg.
pub fn mass_kg_of(id: u32, clusters: &Clusters, particles: &Particles, clumps: &Clumps) -> f64 {
    spheres_of(id, clusters, particles, clumps).1
}

/// The spheres of a present cluster, and its mass, kg.
fn spheres_of(
    id: u32,
    clusters: &Clusters,
    particles: &Particles,
    clumps: &Clumps,
) -> (Vec<Sphere>, f64) {
    let members = clusters.members(id);
    let carrier = members.first().and_then(|&i| clumps.carrier_of(i as usize));
    let spheres: Vec<Sphere> = match carrier {
        // The particles contain only its outer spheres.
        Some(at) => {
            let template = clumps.template(&clumps.all[at]);
            let sphere = |s: &crate::state::clumps::SubSphere| Sphere {
                centre_m: s.place_m,
                radius_m: s.radius_m,
                mass_kg: s.mass_kg,
                inertia_kg_m2: s.inertia_kg_m2,
            };
            template.spheres.iter().map(sphere).collect()
        }
        None => {
            let sphere = |&i: &u32| {
                let (pose, motion) = (&particles.poses[i as usize], &particles.motions[i as usize]);
                Sphere {
                    centre_m: pose.place().into(),
                    radius_m: pose.radius_m(),
                    mass_kg: 1.0 / motion.inverse_mass,
                    inertia_kg_m2: 1.0 / motion.inverse_inertia,
                }
            };
            members.iter().map(sphere).collect()
        }
    };
    let mass_kg = match carrier {
        Some(at) => clumps.template(&clumps.all[at]).mass_kg,
        None => spheres.iter().map(|s| s.mass_kg).sum(),
    };
    (spheres, mass_kg)
}

/// A sphere of a fragment.
#[derive(Debug, Clone, Copy)]
pub struct Sphere {
    /// Centre, m. Length 3.
    pub centre_m: [f64; 3],
    /// m.
    pub radius_m: f64,
    /// kg.
    pub mass_kg: f64,
    /// About its centre, kg m2.
    pub inertia_kg_m2: f64,
}

impl Sphere {
    /// Of a material of 1 kg/m3.
    pub fn of_unit_density(centre_m: [f64; 3], radius_m: f64) -> Self {
        let mass_kg = 4.0 / 3.0 * std::f64::consts::PI * radius_m.powi(3);
        Self {
            centre_m,
            radius_m,
            mass_kg,
            inertia_kg_m2: 0.4 * mass_kg * radius_m * radius_m,
        }
    }
}

/// Lengths of the box around some spheres along their principal axes of inertia, the longest first,
/// m. Zeros for no spheres.
pub fn box_lengths_m(spheres: &[Sphere]) -> [f64; 3] {
    match spheres {
        [] => return [0.0; 3],
        [one] => return [2.0 * one.radius_m; 3],
        _ => {}
    }
    let mut low = Vector3::repeat(f64::INFINITY);
    let mut high = Vector3::repeat(f64::NEG_INFINITY);
    for (place, radius_m) in in_principal_axes(spheres) {
        low = low.inf(&place.add_scalar(-radius_m));
        high = high.sup(&place.add_scalar(radius_m));
    }
    let mut lengths_m: [f64; 3] = (high - low).into();
    lengths_m.sort_by(|a, b| b.total_cmp(a));
    lengths_m
}

/// Side of the smallest square opening that some spheres pass together, in the best direction and
/// turned in the best way, m. Zero for no spheres.
pub fn sieve_m(spheres: &[Sphere]) -> f64 {
    if let [one] = spheres {
        return 2.0 * one.radius_m;
    }
    smallest_opening_m(&in_principal_axes(spheres))
}

/// Centres about the common one, in the principal axes of inertia, and radii, m.
fn in_principal_axes(spheres: &[Sphere]) -> Vec<Ball> {
    let centres_m: Vec<[f64; 3]> = spheres.iter().map(|s| s.centre_m).collect();
    let masses_kg: Vec<f64> = spheres.iter().map(|s| s.mass_kg).collect();
    let inertias_kg_m2: Vec<f64> = spheres.iter().map(|s| s.inertia_kg_m2).collect();
    let properties = of_spheres(&centres_m, &masses_kg, &inertias_kg_m2);
    let to_principal = rotation(properties.axes).inverse();
    let centre = Vector3::from(properties.centre_m);
    let place = |s: &Sphere| to_principal * (Vector3::from(s.centre_m) - centre);
    spheres.iter().map(|s| (place(s), s.radius_m)).collect()
}
