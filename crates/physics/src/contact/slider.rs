//! A spring that slides: tangential friction and elastic-plastic rolling friction are the same,
//! with different units.

use super::kinematics::FrameRotation;
use crate::number::{Number, Vec3};

/// A spring after a step, in the axes of the end of the step. Forces of spring and damper are those
/// that resist the motion.
#[derive(Debug, Clone, Copy)]
pub struct TangentialStep<T> {
    /// Displacement.
    pub spring: Vec3<T>,
    /// Force of the spring.
    pub force: Vec3<T>,
    /// Force of the damper.
    pub damping: Vec3<T>,
    /// Energy stored, J.
    pub stored_j: T,
    /// Energy lost in the step, J.
    pub lost_j: T,
}

/// A spring with the displacement `before` that has `moved` by this much, while its stiffness
/// changed. `before` is in the axes of the beginning of the step, `moved` and `damping` are in
/// those of its middle.
///
/// `kept` is the fraction of the old displacement that is kept: with the ratio of old to new
/// stiffness, the force stays the same; with 1, the displacement. The motion is added halfway
/// through that change. The spring is cut back if its force exceeds `limit`, and the damper is
/// limited such that both together do not exceed it: a sliding contact is not damped, and there is
/// no jump when it begins to slide.
#[inline(always)]
pub fn coulomb_return_map<T: Number>(
    carry: &FrameRotation<T>,
    before: Vec3<T>,
    moved: Vec3<T>,
    [stiffness_before, stiffness]: [T; 2],
    kept: T,
    limit: T,
    damping: Vec3<T>,
) -> TangentialStep<T> {
    let before = carry.to_middle(before);
    let stuck = before * kept + moved * kept.plus(1.0).scale(0.5);
    let needed_square = stiffness * stiffness * stuck.square();
    let largest = limit.maximum(needed_square.sqrt());
    let held = limit.if_positive(limit / largest);
    let spring = stuck * held;
    let force = spring * stiffness;

    // The mean of the forces times the motion, minus the growth of the stored energy.
    let given = stiffness_before * before.dot(before + moved);
    let taken = force.dot(spring - moved);

    // Largest q with |force + q damping| <= limit, and at most 1. So as not to wait for `held`,
    // `along` is that of the force before it is cut back. If it is not cut back, it is the force;
    // otherwise there is no room, q is in proportion to the force, and `limit / largest` is the
    // part of it that is left.
    let along = stiffness * stuck.dot(damping);
    let square = damping.square();
    let slack = limit * limit - needed_square;
    let room = slack.if_positive(slack);
    let q = limit * ((along * along + square * room).sqrt() - along);
    let fraction = q.if_positive(q / q.maximum(square * largest));

    let at_end = carry.to_end(spring);
    TangentialStep {
        spring: at_end,
        force: at_end * stiffness,
        damping: carry.to_end(damping * fraction),
        stored_j: force.dot(spring).scale(0.5),
        lost_j: (given - taken).scale(0.5),
    }
}
