//! Mass, position and motion of clusters.

use nalgebra::{Matrix3, Vector3};
use serde::Serialize;

use super::detection::Clusters;
use crate::state::clumps::{Clump, Clumps, Template};
use crate::state::particles::{Motion, Particles};

/// A cluster as one body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Fragment {
    /// Its number in [`Clusters::history`].
    pub fragment_id: u32,
    /// The cluster that it broke off.
    pub parent_id: Option<u32>,
    /// Its body: number in [`crate::state::model::Model::bodies`].
    pub body: u32,
    /// Number of its particles.
    pub particles: u32,
    /// Sum over its particles, kg.
    pub mass_kg: f64,
    /// Centre of mass, m. Length 3.
    pub centre_m: [f64; 3],
    /// Of the centre of mass, m/s. Length 3.
    pub velocity_m_s: [f64; 3],
    /// Of the rigid body with the same angular momentum about the centre, rad/s; the spin of a
    /// single sphere. Length 3.
    pub angular_velocity_rad_s: [f64; 3],
    /// Angular momentum about the centre of mass, spins included, kg m2/s. Length 3.
    pub angular_momentum_kg_m2_s: [f64; 3],
    /// Resultant force on its particles, N: bonds within it cancel. Length 3.
    pub force_n: [f64; 3],
    /// Diameter of the sphere with the volume of its particles, where overlaps count twice, m.
    pub equivalent_diameter_m: f64,
    /// Diagonal of the box around its spheres, along the axes of space, m.
    pub box_diagonal_m: f64,
}

/// All intact clusters, in the order of their numbers. `now`: motions of particles and clumps at
/// the time of the poses, if different from the present ones.
pub fn fragments(
    clusters: &Clusters,
    particles: &Particles,
    clumps: &Clumps,
    now: Option<(&[Motion], &[Clump])>,
) -> Vec<Fragment> {
    let (motions, moving) = now.unwrap_or((&particles.motions, &clumps.all));
    let mut fragments: Vec<Fragment> = clusters
        .living()
        .map(|id| fragment(id, clusters, particles, motions))
        .collect();
    for clump in moving {
        if let Ok(at) =
            fragments.binary_search_by_key(&clump.cluster, |fragment| fragment.fragment_id)
        {
            fragments[at] = as_fragment(clump, clumps.template(clump), &fragments[at]);
        }
    }
    fragments
}

/// Mass of the cluster of each particle, kg. Length: particles.
pub fn fragment_masses_kg(clusters: &Clusters, particles: &Particles, clumps: &Clumps) -> Vec<f64> {
    let mut of_cluster_kg = vec![0.0; clusters.history.len()];
    let free = &particles.motions[..particles.free];
    for (id, motion) in clusters.of_particle.iter().zip(free) {
        of_cluster_kg[*id as usize] += 1.0 / motion.inverse_mass;
    }
    for clump in &clumps.all {
        of_cluster_kg[clump.cluster as usize] = clumps.template(clump).mass_kg;
    }
    let of_particle = clusters.of_particle.iter();
    of_particle.map(|id| of_cluster_kg[*id as usize]).collect()
}

/// A clump, of which the particles contain only the outer spheres.
fn as_fragment(clump: &Clump, template: &Template, outer: &Fragment) -> Fragment {
    let cubes: f64 = template.spheres.iter().map(|s| s.radius_m.powi(3)).sum();
    Fragment {
        particles: template.spheres.len() as u32,
        mass_kg: template.mass_kg,
        centre_m: clump.place_m,
        velocity_m_s: clump.velocity_m_s,
        angular_velocity_rad_s: clump.spin_rad_s(template).into(),
        angular_momentum_kg_m2_s: clump.angular_momentum,
        force_n: clump.force_n,
        equivalent_diameter_m: 2.0 * cubes.cbrt(),
        ..*outer
    }
}

/// Mass, kg, and centre of mass, m, of some particles.
pub(crate) fn mass_and_centre(members: &[u32], particles: &Particles) -> (f64, Vector3<f64>) {
    let place = |i: u32| particles.poses[i as usize].place();
    // Relative to one of them, so that a position far from the origin costs no digits.
    let origin = members.first().map_or(Vector3::zeros(), |i| place(*i));
    let (mut mass_kg, mut moment) = (0.0, Vector3::zeros());
    for &i in members {
        let own_kg = 1.0 / particles.motions[i as usize].inverse_mass;
        mass_kg += own_kg;
        moment += own_kg * (place(i) - origin);
    }
    (mass_kg, origin + moment / mass_kg)
}

/// A cluster that is not a clump, with these motions of all particles. Length of `motions`:
/// particles.
pub fn fragment(
    id: u32,
    clusters: &Clusters,
    particles: &Particles,
    motions: &[Motion],
) -> Fragment {
    let members = clusters.members(id);
    let place = |i: u32| particles.poses[i as usize].place();
    let mass = |i: u32| 1.0 / particles.motions[i as usize].inverse_mass;
    let velocity = |i: u32| Vector3::from(motions[i as usize].velocity_m_s);

    let (mass_kg, centre) = mass_and_centre(members, particles);
    let mut momentum = Vector3::zeros();
    let mut force = Vector3::zeros();
    let mut cubes = 0.0;
    let mut low = Vector3::repeat(f64::INFINITY);
    let mut high = Vector3::repeat(f64::NEG_INFINITY);
    for &i in members {
        let radius = particles.poses[i as usize].radius_m();
        momentum += mass(i) * velocity(i);
        let [x, y, z, _] = particles.wrenches[i as usize].force_n;
        force += Vector3::new(x, y, z);
        cubes += radius.powi(3);
        low = low.inf(&place(i).add_scalar(-radius));
        high = high.sup(&place(i).add_scalar(radius));
    }
    let mean_velocity = momentum / mass_kg;

    let mut inertia = Matrix3::zeros();
    let mut angular_momentum = Vector3::zeros();
    for &i in members {
        let own = 1.0 / particles.motions[i as usize].inverse_inertia;
        let arm = place(i) - centre;
        let spin = Vector3::from(motions[i as usize].spin_rad_s);
        angular_momentum += mass(i) * arm.cross(&(velocity(i) - mean_velocity)) + own * spin;
        inertia += Matrix3::from_diagonal_element(own + mass(i) * arm.norm_squared())
            - mass(i) * arm * arm.transpose();
    }
    let angular_velocity = match members {
        [one] => motions[*one as usize].spin_rad_s.into(),
        _ => inertia
            .cholesky()
            .map_or(Vector3::zeros(), |c| c.solve(&angular_momentum)),
    };
    Fragment {
        fragment_id: id,
        parent_id: clusters.history[id as usize].parent,
        body: clusters.history[id as usize].body,
        particles: members.len() as u32,
        mass_kg,
        centre_m: centre.into(),
        velocity_m_s: mean_velocity.into(),
        angular_velocity_rad_s: angular_velocity.into(),
        angular_momentum_kg_m2_s: angular_momentum.into(),
        force_n: force.into(),
        equivalent_diameter_m: 2.0 * cubes.cbrt(),
        box_diagonal_m: (high - low).norm(),
    }
}

/// Mass fraction of the heaviest fragment; 0 if there is none.
pub fn mass_fraction_of_largest(masses_kg: impl Iterator<Item = f64> + Clone) -> f64 {
    let total: f64 = masses_kg.clone().sum();
    let largest = masses_kg.fold(0.0, f64::max);
    if total > 0.0 { largest / total } else { 0.0 }
}
