//! The incremental formulation: shear force and moment are summed step by step from the relative
//! motion at the contact point.
//!
//! Sources: Chen et al. 2022, eqs. 1-7, tables 1, 2 and 8; MUSEN's elastic solid bond. One kernel
//! for all five models, which differ only in stiffness and contact point. Offered for comparison:
//! the [total formulation](super::total) needs no history.
//!
//! Differences from the printed formulas:
//! - The increment uses the axis halfway through the step, half of it before and half after the
//!   rotation about the axis: the step is time-reversible. With the axis at the end of the step,
//!   energy grows.
//! - The history is rotated with the axis and also with the mean spin of the ends about it; MUSEN's
//!   T rotates it with the axis only.
//! - The normal force follows from the length (as in MUSEN), not from a sum of increments, which
//!   would drift.
//! - MUSEN's relative spin has the opposite sense to its relative velocity, and its last product is
//!   a cross product: here everything is b relative to a.

use super::BondLoad;
use super::stiffness::Stiffness;
use super::total::{BondEnergy, BondForces};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// History of a bond. Both values are 0 when it is created.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Shear force on the second end, across the bond, N.
    pub shear_force: Vector3<f64>,
    /// Moment on the second end, N m: the part along the bond is torsion, the rest bending.
    pub moment: Vector3<f64>,
}

impl Default for History {
    fn default() -> Self {
        Self {
            shear_force: Vector3::zeros(),
            moment: Vector3::zeros(),
        }
    }
}

/// Motion of a bond's ends in one step, between two evaluations of its forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// From the first end's centre to the second's, at the start of the step, m.
    pub apart_before: Vector3<f64>,
    /// The same at its end, m.
    pub apart_after: Vector3<f64>,
    /// Spins halfway through the step (leapfrog), times the time step, rad.
    pub turns: [Vector3<f64>; 2],
}

/// History at the end of a step.
#[inline(always)]
pub fn advance(stiffness: &Stiffness, history: &History, step: &Step) -> History {
    let [lever_a, lever_b] = stiffness.levers_m;
    let [turn_a, turn_b] = step.turns;
    let before = step.apart_before.normalize();
    let middle = (before + step.apart_after.normalize()).normalize();

    // Displacement and rotation of b relative to a at the contact point, which divides the present
    // length in the ratio of the levers.
    let apart = 0.5 * (step.apart_before + step.apart_after);
    let carried = (lever_a * turn_a + lever_b * turn_b) / (lever_a + lever_b);
    let moved = step.apart_after - step.apart_before - carried.cross(&apart);
    let across = moved - middle * moved.dot(&middle);
    let turned = turn_b - turn_a;
    let excess = stiffness.torsion - stiffness.bending;
    let half_force = -0.5 * stiffness.shear * across;
    let half_moment = -0.5 * (stiffness.bending * turned + middle * (excess * turned.dot(&middle)));

    // To the middle of the rotation of the axis, rotated about the axis there, and on to its end:
    // the same rotation twice, as the middle halves the angle.
    let rotation = before.cross(&middle);
    let per_rotation = 1.0 / (1.0 + before.dot(&middle));
    let spin = middle * (0.25 * (turn_a + turn_b).dot(&middle));
    let per_spin = 2.0 / (1.0 + spin.norm_squared());
    let carry = |remembered: &Vector3<f64>, half: &Vector3<f64>| {
        let there = rotated(remembered, &rotation, per_rotation) + half;
        let spun = there + per_spin * spin.cross(&(there + spin.cross(&there)));
        rotated(&(spun + half), &rotation, per_rotation)
    };
    History {
        shear_force: carry(&history.shear_force, &half_force),
        moment: carry(&history.moment, &half_moment),
    }
}

/// Forces of a bond with this history; `apart` is the vector from the first end's centre to the
/// second's.
#[inline(always)]
pub fn bond_forces(stiffness: &Stiffness, history: &History, apart_m: &Vector3<f64>) -> BondForces {
    let [lever_a, lever_b] = stiffness.levers_m;
    let initial = lever_a + lever_b;
    let length = apart_m.norm();
    let c = apart_m / length;
    let stretch = length - initial;
    let normal = stiffness.normal * stretch;
    let torsion = history.moment.dot(&c);
    let bending = history.moment - c * torsion;
    let shear_moment = apart_m.cross(&history.shear_force) / initial;
    BondForces {
        force_on_b: history.shear_force - c * normal,
        torques: [
            -history.moment - lever_a * shear_moment,
            history.moment - lever_b * shear_moment,
        ],
        energy: BondEnergy {
            normal: 0.5 * normal * stretch,
            shear: stored_j(history.shear_force.norm_squared(), stiffness.shear),
            torsion: stored_j(torsion * torsion, stiffness.torsion),
            bending: stored_j(bending.norm_squared(), stiffness.bending),
        },
        load: BondLoad {
            normal_n: normal,
            shear_n: history.shear_force.norm(),
            torsion_n_m: torsion.abs(),
            bending_n_m: bending.norm(),
        },
    }
}

/// Energy of a spring from the square of its load, J; 0 without a spring.
#[inline(always)]
fn stored_j(load_squared: f64, stiffness: f64) -> f64 {
    if stiffness == 0.0 {
        0.0
    } else {
        0.5 * load_squared / stiffness
    }
}

/// A vector under the rotation that takes one unit vector to another; `rotation` is their cross
/// product and `per_rotation` is one over (1 + their dot product).
#[inline(always)]
fn rotated(vector: &Vector3<f64>, rotation: &Vector3<f64>, per_rotation: f64) -> Vector3<f64> {
    let once = rotation.cross(vector);
    vector + once + per_rotation * rotation.cross(&once)
}
