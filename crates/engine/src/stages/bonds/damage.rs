//! Bonds that soften: the growth of their damage, and those that are pressed, since a crack that
//! closes carries pressure as the intact bond did.

use nalgebra::{UnitQuaternion, Vector3};

use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::particles::{Motion, Particles, Pose};
use dem_physics::bond::damage::{Growth, growth};
use dem_physics::bond::failure::{Cause, Criteria, Factors, stresses};
use dem_physics::bond::total::{BondForces, End};

/// What a bond loses that has reached its strength.
pub(super) struct Loss {
    /// Why it broke. None: it is only damaged.
    pub(super) broke: Option<Cause>,
    /// Damage afterwards.
    pub(super) damage: f64,
    /// The part of its force on the second end, N, and of its torques, N m, that is no more.
    pub(super) force_on_b: Vector3<f64>,
    pub(super) torques: [Vector3<f64>; 2],
    /// Energy released at once, J.
    pub(super) released_j: f64,
    /// Energy spent by the damage, J.
    pub(super) spent_j: f64,
}

/// Adds the forces of damaged bonds that are pressed: see [`press`]. Returns the number of damaged
/// bonds.
pub(crate) fn press_damaged_bonds(state: &mut State) -> usize {
    let State {
        bonds,
        particles,
        scratch,
        ..
    } = state;
    press(bonds, particles, &mut scratch.crushed);
    bonds.damaged.len()
}

/// Adds the axial force that damaged bonds carry under pressure beyond that of their remaining
/// stiffness to the wrenches, and lists those that are crushed.
pub(crate) fn press(bonds: &Bonds, particles: &mut Particles, crushed: &mut Vec<u32>) {
    crushed.clear();
    for &at in &bonds.damaged {
        let at = at as usize;
        let ends = bonds.ends[at].map(|end| end as usize);
        if bonds.is_broken(at) || particles.sleeps(ends[0]) {
            continue;
        }
        let stretch_m = bonds.stretch_m(at, &particles.poses);
        if stretch_m >= 0.0 {
            continue;
        }
        let more = bonds.histories.damages[at].normal - bonds.normal(at);
        let [a, b] = ends.map(|end| particles.poses[end].place());
        let on_b = -more * stretch_m * (b - a).normalize();
        particles.wrenches[ends[0]].add(&-on_b, &Default::default());
        particles.wrenches[ends[1]].add(&on_b, &Default::default());
        if is_crushed(bonds, at, &particles.poses) {
            crushed.push(at as u32);
        }
    }
}

/// Whether a bond has reached its compressive strength.
pub(super) fn is_crushed(bonds: &Bonds, at: usize, poses: &[Pose]) -> bool {
    let Some(criteria) = &bonds.rules[bonds.rule_of(at)].criteria else {
        return false;
    };
    let strength_pa = criteria.compressive_strength_pa * bonds.undamaged_strength_factor(at);
    strength_pa.is_finite() && {
        let load = bonds.forces(at, poses).load;
        let pressed_pa = stresses(&load, bonds.radius_m(at)).pressed_edge_pa();
        pressed_pa > 0.0 && pressed_pa >= strength_pa
    }
}

/// Growth of the damage of a bond at the present poses. None: it does not grow.
pub(super) fn growth_of(
    bonds: &Bonds,
    at: usize,
    particles: &Particles,
    criteria: &Criteria,
    factors: Factors,
) -> Option<Growth> {
    let ends = bonds.ends[at].map(|end| particles.poses[end as usize].end());
    let intact = bonds.forces_if_damaged(at, &ends, 0.0);
    let stresses = stresses(&intact.load, bonds.radius_m(at));
    let ratios = bonds.opening_ratios(at);
    growth(criteria, &stresses, factors, &ratios, bonds.damage(at))
}

/// What a bond loses whose damage grows in a kick after a drift of `drift_s`; `forces`: with its
/// damage before.
///
/// The energy spent is the work of the ends in the drift, with the force before it and the new one
/// after it, minus what the bond stores more: the same work as in the balance of energy.
pub(super) fn softened(
    bonds: &Bonds,
    at: usize,
    particles: &Particles,
    forces: &BondForces,
    growth: Growth,
    drift_s: f64,
) -> Loss {
    let ends = bonds.ends[at].map(|end| end as usize);
    let motions = ends.map(|end| &particles.motions[end]);
    let now = ends.map(|end| particles.poses[end].end());
    let earlier = [0, 1].map(|end| earlier(&now[end], motions[end], drift_s));
    let before = bonds.forces_if_damaged(at, &earlier, bonds.damage(at));
    // A broken bond carries no pressure either.
    let after = if growth.damage < 1.0 {
        bonds.forces_if_damaged(at, &now, growth.damage)
    } else {
        BondForces::NONE
    };
    let work_j = -0.5 * drift_s * (power_w(&before, motions) + power_w(&after, motions));
    Loss {
        broke: (growth.damage >= 1.0).then_some(growth.cause),
        damage: growth.damage,
        force_on_b: forces.force_on_b - after.force_on_b,
        torques: [0, 1].map(|end| forces.torques[end] - after.torques[end]),
        released_j: 0.0,
        spent_j: work_j + before.energy.total() - after.energy.total(),
    }
}

/// An end before a drift with this motion.
pub(super) fn earlier(now: &End, motion: &Motion, drift_s: f64) -> End {
    let turn = -drift_s * Vector3::from(motion.spin_rad_s);
    End {
        position_m: now.position_m - drift_s * Vector3::from(motion.velocity_m_s),
        turned: UnitQuaternion::from_scaled_axis(turn) * now.turned,
    }
}

/// Power of the forces of a bond on its ends, W.
pub(super) fn power_w(forces: &BondForces, motions: [&Motion; 2]) -> f64 {
    let on_ends = [-forces.force_on_b, forces.force_on_b];
    let of_end = |end: usize| {
        let (v, w) = (motions[end].velocity_m_s, motions[end].spin_rad_s);
        on_ends[end].dot(&Vector3::from(v)) + forces.torques[end].dot(&Vector3::from(w))
    };
    of_end(0) + of_end(1)
}
