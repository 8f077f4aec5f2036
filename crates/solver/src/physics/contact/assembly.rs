//! A contact from what is remembered of it to what it does, be it of two particles or of a particle
//! and a wall: relaxation, law, friction, torques and losses.

use super::kinematics::{ContactKinematics, torques};
use super::relaxation::relaxed;
use super::rolling::RollingFriction;
use super::{ContactSprings, Damped, NormalLaw, Response, response};
use crate::physics::number::{Number, Vec3};

/// What is remembered of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoredContact<T = f64> {
    /// Its springs.
    pub springs: ContactSprings<T>,
    /// What its damping did to the second end.
    pub damped: Damped<T>,
    /// Overlap at which its law begins, m.
    pub origin_m: T,
}

/// What comes of a contact in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assembled<T = f64> {
    /// To be remembered.
    pub remembered: StoredContact<T>,
    /// Overlap of its law, m.
    pub overlap_m: T,
    /// What it does and stores.
    pub response: Response<T>,
    /// Torques on its ends about their centres, N m.
    pub torques: [Vec3<T>; 2],
    /// Energy that friction took in the step, J.
    pub friction_j: T,
    /// Energy that damping took in the step, J.
    pub damping_j: T,
}

/// What comes of a contact after a step of `dt`, s. A pair that parted overlapping is ordinary
/// below `least_overlap` times its effective radius.
#[inline(always)]
pub fn assemble<T: Number>(
    law: &impl NormalLaw<T>,
    rolling: &impl RollingFriction<T>,
    touch: &ContactKinematics<T>,
    before: &StoredContact<T>,
    least_overlap: f64,
    dt: f64,
) -> Assembled<T> {
    let least_m = touch.effective_radius_m.scale(least_overlap);
    let relaxed = relaxed(touch.overlap_m, before.origin_m, least_m);
    let touch = ContactKinematics {
        overlap_m: relaxed.overlap_m,
        ..*touch
    };
    let response = response(law, rolling, &touch, &before.springs, dt);
    let damped = response.damping.total();
    Assembled {
        remembered: StoredContact {
            springs: response.springs,
            damped,
            origin_m: relaxed.origin_m,
        },
        overlap_m: touch.overlap_m,
        torques: torques(&touch, response.force_on_b, response.moment_on_b),
        friction_j: response.lost.sliding + response.lost.rolling,
        damping_j: damped.lost_j(&before.damped, &touch, dt),
        response,
    }
}
