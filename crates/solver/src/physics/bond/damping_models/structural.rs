//! Structural damping: a fraction of what a bond carries resists its relative motion, mode by mode.
//!
//! F_d = -gamma |F| sign(v), M_d = -gamma |M| sign(w), with the relative velocity v and spin w at
//! the contact point, along the bond and across it, about it and across it. Across the bond,
//! sign(v) is the direction of v.
//!
//! The rule that Chen et al. 2022, eqs. 11 and 12, apply to the motion of particles brakes free
//! flight and carries a part of the weight. This one acts on the relative motion of two ends: what
//! moves as a rigid body is not damped, and momentum and angular momentum are untouched. A mode
//! loses the same fraction of its amplitude in every cycle, whatever its frequency: it moves
//! outwards with the stiffness (1 + gamma) k and back with (1 - gamma) k, so that half a cycle
//! multiplies its speed by sqrt((1 - gamma)/(1 + gamma)).

use nalgebra::Vector3;

use crate::physics::bond::BondLoad;
use crate::physics::bond::damping::{DampingForces, EndMotion, relative_motion};
use crate::physics::number::Vec3;

/// Structural damping, by this gamma, of a bond under this load that is now `length_m` long along
/// the unit vector `c` from a to b; levers as in
/// [`damping_forces`](crate::physics::bond::damping::damping_forces).
pub fn structural_forces(
    gamma: f64,
    load: &BondLoad,
    levers_m: &[f64; 2],
    c: &Vector3<f64>,
    length_m: f64,
    ends: &[EndMotion; 2],
) -> DampingForces {
    let motions = ends.map(|end| [Vec3::from(end.velocity_m_s), Vec3::from(end.spin_rad_s)]);
    let apart = length_m * c;
    let moved = relative_motion(*levers_m, Vec3::from(apart), motions);
    let arm_a = moved.share * apart;
    let force = resisting(c, moved.velocity_m_s.into(), load.normal_n, load.shear_n);
    let moment = resisting(
        c,
        moved.spin_rad_s.into(),
        load.torsion_n_m,
        load.bending_n_m,
    );
    let (force, moment) = (gamma * force, gamma * moment);
    DampingForces {
        force_on_b: -force,
        torques: [
            moment + arm_a.cross(&force),
            (apart - arm_a).cross(&force) - moment,
        ],
    }
}

/// The magnitudes of loads along and across `c`, each with the direction of the motion there.
fn resisting(c: &Vector3<f64>, motion: Vector3<f64>, along: f64, across: f64) -> Vector3<f64> {
    let speed = motion.dot(c);
    let sideways = motion - c * speed;
    let sign = if speed == 0.0 { 0.0 } else { speed.signum() };
    let side = sideways.try_normalize(0.0).unwrap_or_default();
    c * (along.abs() * sign) + side * across
}
