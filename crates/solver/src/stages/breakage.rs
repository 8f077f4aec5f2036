//! Bonds that have reached their strength break: checked once more by themselves, with the rate of their elongation where it strengthens them.

use dem_io::scene::RateOf;
use nalgebra::Vector3;

use crate::physics::bond::failure::{Cause, Factors, cause, stresses, utilisation};
use crate::physics::bond::strain_rate::{dynamic_increase_factor, elongation_rate};
use crate::physics::bond::total::BondForces;
use crate::state::bonds::Bonds;
use crate::state::particles::Particles;
use crate::state::partitions::Partition;

/// A bond that has broken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Break {
    /// Which bond.
    pub bond: u32,
    /// Halfway between its ends, m. Length 3.
    pub place_m: [f64; 3],
    /// What it failed by.
    pub cause: Cause,
    /// Elastic energy that it held, J.
    pub released_j: f64,
    /// Its two particles, and the force, N, and torque, N m, on each: x, y, z of both. They acted until the break.
    pub ends: [(u32, [f64; 6]); 2],
}

/// Breaks the bonds that the partitions list, if they fail, and adds them to `broken`, in the order of the bonds.
///
/// The bond acts until this moment: its ends get their half of the kick, `half_kick_s`, and its force is taken back from what moves them on.
/// Returns how many bonds were looked at whose strength depends on the rate of strain.
pub fn break_bonds(
    bonds: &mut Bonds,
    particles: &mut Particles,
    partitions: &[Partition],
    half_kick_s: f64,
    broken: &mut Vec<Break>,
) -> usize {
    // A partition lists its bonds of the total formulation before those of the incremental one.
    let mut failing: Vec<u32> = partitions
        .iter()
        .flat_map(|s| &s.failing)
        .copied()
        .collect();
    failing.sort_unstable();
    let by_rate = |at: &&u32| {
        let rule = &bonds.rules[bonds.rule_of(**at as usize)];
        rule.strengthening_from_1_s.is_some()
    };
    let rates = failing.iter().filter(by_rate).count();
    // All are looked at before the first is taken away: a break changes the velocities of its ends, and rates of strain come from velocities.
    let failing: Vec<(usize, BondForces, Cause)> = failing
        .into_iter()
        .filter_map(|at| {
            let at = at as usize;
            let forces = bonds.forces(at, &particles.poses);
            fails(bonds, at, particles, &forces).map(|cause| (at, forces, cause))
        })
        .collect();
    for (at, forces, cause) in failing {
        broken.push(remove(bonds, particles, at, &forces, cause, half_kick_s));
    }
    rates
}

fn fails(bonds: &Bonds, at: usize, particles: &Particles, forces: &BondForces) -> Option<Cause> {
    let rule = &bonds.rules[bonds.rule_of(at)];
    let criteria = rule.criteria?;
    let stresses = stresses(&forces.load, bonds.radius_m(at));
    let rate = rule.strengthening_from_1_s.map_or(1.0, |from| {
        let [a, b] = bonds.ends[at].map(|end| end as usize);
        let c = (particles.poses[b].place() - particles.poses[a].place()).normalize();
        let velocities = [a, b].map(|end| Vector3::from(particles.motions[end].velocity_m_s));
        let length_m = bonds.initial_length_m(at);
        let rate_1_s = match rule.rate_of {
            RateOf::Elongation => elongation_rate(&c, &velocities, length_m),
            RateOf::RelativeVelocity => (velocities[1] - velocities[0]).norm() / length_m,
        };
        dynamic_increase_factor(rate_1_s, from)
    });
    let scatter = bonds.strength_factor(at);
    let factors = Factors { scatter, rate };
    (utilisation(&criteria, &stresses, factors) >= 1.0)
        .then(|| cause(&criteria, &stresses, factors))
}

fn remove(
    bonds: &mut Bonds,
    particles: &mut Particles,
    at: usize,
    forces: &BondForces,
    cause: Cause,
    half_kick_s: f64,
) -> Break {
    let ends = bonds.ends[at].map(|end| end as usize);
    let on_ends = [-forces.force_on_b, forces.force_on_b];
    for ((end, force), torque) in ends.into_iter().zip(on_ends).zip(forces.torques) {
        particles.wrenches[end].add(&-force, &-torque);
        let motion = &mut particles.motions[end];
        let per_mass = half_kick_s * motion.inverse_mass;
        let per_inertia = half_kick_s * motion.inverse_inertia;
        for k in 0..3 {
            motion.velocity_m_s[k] += per_mass * force[k];
            motion.spin_rad_s[k] += per_inertia * torque[k];
        }
    }
    bonds.set_broken(at);
    let [a, b] = ends.map(|end| particles.poses[end].place());
    Break {
        bond: at as u32,
        place_m: (0.5 * (a + b)).into(),
        cause,
        released_j: forces.energy.total(),
        ends: [0, 1].map(|end| {
            let [fx, fy, fz]: [f64; 3] = on_ends[end].into();
            let [tx, ty, tz]: [f64; 3] = forces.torques[end].into();
            (ends[end] as u32, [fx, fy, fz, tx, ty, tz])
        }),
    }
}
