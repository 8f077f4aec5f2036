//! Computes a contact from its history to its forces, between two particles or a particle and a
//! wall: relaxation, law, friction, torques and losses.

use super::kinematics::{ContactKinematics, torques};
use super::normal::NormalLaw;
use super::relaxation::relaxed;
use super::rolling::RollingFriction;
use super::{ContactSprings, Damped, Response, response};
use crate::number::{Number, Vec3};

/// History of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoredContact<T = f64> {
    /// Its springs.
    pub springs: ContactSprings<T>,
    /// Its previous damping force and moment on the second end.
    pub damped: Damped<T>,
    /// Overlap at which its law begins, m.
    pub origin_m: T,
}

/// Result for a contact in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assembled<T = f64> {
    /// New history.
    pub remembered: StoredContact<T>,
    /// Overlap of its law, m.
    pub overlap_m: T,
    /// Forces and energies.
    pub response: Response<T>,
    /// Torques on its ends about their centres, N m.
    pub torques: [Vec3<T>; 2],
    /// Energy lost to friction in the step, J.
    pub friction_j: T,
    /// Energy lost to damping in the step, J.
    pub damping_j: T,
}

/// Result for a contact after a step of `dt`, s. A pair that separated while overlapping becomes
/// ordinary below `least_overlap` times its effective radius.
#[inline(always)]
pub fn assemble<T: Number, L: NormalLaw<T>>(
    law: &L,
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
    let [lost, remembered] = if L::ATTRACTS {
        // See `jumps`: what is counted in this step is counted back in the next.
        let [less, more] = [-response.jump_n, response.jump_n];
        [less, more].map(|jump_n| Damped {
            force_n: damped.force_n + jump_n,
            ..damped
        })
    } else {
        [damped; 2]
    };
    Assembled {
        remembered: StoredContact {
            springs: response.springs,
            damped: remembered,
            origin_m: relaxed.origin_m,
        },
        overlap_m: touch.overlap_m,
        torques: torques(&touch, response.force_on_b, response.moment_on_b),
        friction_j: response.lost.sliding + response.lost.rolling,
        damping_j: lost.lost_j(&before.damped, &touch, dt),
        response,
    }
}
