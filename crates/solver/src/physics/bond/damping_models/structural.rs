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
//! multiplies its speed by sqrt((1 - gamma)/(1 + gamma)). Like dry friction it can hold a load.

use nalgebra::Vector3;

use crate::physics::bond::BondLoad;
use crate::physics::bond::damping::{
    DampingCoefficients, DampingForces, EndMotion, relative_motion,
};
use crate::physics::number::Vec3;

/// Structural damping, by this gamma, of a bond under this load that is now `length_m` long along
/// the unit vector `c` from a to b; levers as in
/// [`damping_forces`](crate::physics::bond::damping::damping_forces). Each mode resists at most as
/// much as the dashpots `most`, which is less than the fraction of its load where it is slow.
pub fn structural_forces(
    gamma: f64,
    load: &BondLoad,
    most: &DampingCoefficients,
    levers_m: &[f64; 2],
    c: &Vector3<f64>,
    length_m: f64,
    ends: &[EndMotion; 2],
) -> DampingForces {
    let motions = ends.map(|end| [Vec3::from(end.velocity_m_s), Vec3::from(end.spin_rad_s)]);
    let apart = length_m * c;
    let moved = relative_motion(*levers_m, Vec3::from(apart), motions);
    let arm_a = moved.share * apart;
    let force = resisting(
        c,
        moved.velocity_m_s.into(),
        [gamma * load.normal_n, gamma * load.shear_n],
        [most.normal, most.shear],
    );
    let moment = resisting(
        c,
        moved.spin_rad_s.into(),
        [gamma * load.torsion_n_m, gamma * load.bending_n_m],
        [most.torsion, most.bending],
    );
    DampingForces {
        force_on_b: -force,
        torques: [
            moment + arm_a.cross(&force),
            (apart - arm_a).cross(&force) - moment,
        ],
    }
}

/// Friction along `c` and across it in the direction of the motion there, or what the dashpots
/// resist if that is less.
fn resisting(
    c: &Vector3<f64>,
    motion: Vector3<f64>,
    friction: [f64; 2],
    most: [f64; 2],
) -> Vector3<f64> {
    let speed = motion.dot(c);
    let sideways = motion - c * speed;
    let along = friction[0].abs().min(most[0] * speed.abs());
    let across = friction[1].min(most[1] * sideways.norm());
    let side = sideways.try_normalize(0.0).unwrap_or_default();
    c * along.copysign(speed) + side * across
}
