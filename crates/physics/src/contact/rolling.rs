//! Rolling friction: a moment against rolling. Twisting about the normal is free.
//!
//! Rolling w_t is the part of the relative spin across the normal; the moment is at most mu_r R* N.
//!
//! - Constant moment (type A of Ai et al. 2011): against w_t, whatever its magnitude. Slow rolling
//!   is resisted by a viscous moment instead, which removes a
//!   [small fraction](ConstantMoment::FRACTION) of the rolling in a step: so a body at rest neither
//!   jitters nor is turned back. It does not hold either: under a constant torque below the limit
//!   it creeps, the more slowly the smaller the time step.
//! - Elastic-plastic spring and dashpot (type C of Ai et al. 2011): k_r = 2.25 k_n mu_r^2 R*^2 with
//!   k_n the tangent normal stiffness, slipping at the limit; c_r = 2 eta sqrt(J k_r) with J the
//!   reduced inertia about the contact point. It holds a body at rest. Unlike there, damping counts
//!   towards the limit, so that it fades out instead of jumping to 0 when the spring begins to
//!   slip; and the spring is treated like the tangential one when the load changes.

use super::kinematics::{ContactKinematics, FrameRotation};
use super::normal::NormalResponse;
use super::slider::{TangentialStep, coulomb_return_map};
use crate::number::{Number, Vec3};
use serde::Serialize;

/// Rolling friction of contacts.
pub trait RollingFriction<T: Number> {
    /// Whether it has a history: otherwise springs and damping are 0.
    const REMEMBERS: bool;

    /// The spring after a step that began with the displacement `before`, in the axes of that
    /// moment, under the normal force `pressed`, N.
    fn roll(
        &self,
        normal_response: &NormalResponse<T>,
        touch: &ContactKinematics<T>,
        carry: &FrameRotation<T>,
        before: Vec3<T>,
        pressed: T,
        dt: f64,
    ) -> TangentialStep<T>;

    /// Stiffness, N m/rad, and damping, N m s/rad, of small rolling.
    fn linearised(
        &self,
        normal_response: &NormalResponse<T>,
        touch: &ContactKinematics<T>,
    ) -> [T; 2];
}

/// No rolling friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoRolling;

/// Constant moment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ConstantMoment<T = f64> {
    /// mu_r, relative to R*.
    pub friction: T,
}

/// Elastic-plastic spring and dashpot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ElasticPlastic<T = f64> {
    /// mu_r, relative to R*.
    pub friction: T,
    /// eta, damping ratio: 0.3 in Ai et al. 2011.
    pub damping_ratio: T,
}

impl ConstantMoment {
    /// Slow rolling loses this fraction in a step, computed with the inertia about the contact
    /// point. That is 3.5 times a sphere's inertia about its centre: a dozen contacts with equal
    /// spheres, each with half of it, together still remove no more than all of its spin.
    pub const FRACTION: f64 = 1.0 / 21.0;
}

impl ConstantMoment {
    /// The same for several contacts at once, one for each lane.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T) -> ConstantMoment<T> {
        ConstantMoment {
            friction: all(self.friction),
        }
    }
}

impl ElasticPlastic {
    /// The same for several contacts at once, one for each lane.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T) -> ElasticPlastic<T> {
        ElasticPlastic {
            friction: all(self.friction),
            damping_ratio: all(self.damping_ratio),
        }
    }
}

impl<T: Number> RollingFriction<T> for NoRolling {
    const REMEMBERS: bool = false;

    #[inline(always)]
    fn roll(
        &self,
        _: &NormalResponse<T>,
        touch: &ContactKinematics<T>,
        _: &FrameRotation<T>,
        _: Vec3<T>,
        _: T,
        _: f64,
    ) -> TangentialStep<T> {
        let none = touch.effective_radius_m.zero();
        damped(Vec3(none, none, none))
    }

    #[inline(always)]
    fn linearised(&self, _: &NormalResponse<T>, touch: &ContactKinematics<T>) -> [T; 2] {
        let none = touch.effective_radius_m.zero();
        [none, none]
    }
}

impl<T: Number> RollingFriction<T> for ConstantMoment<T> {
    const REMEMBERS: bool = true;

    #[inline(always)]
    fn roll(
        &self,
        _: &NormalResponse<T>,
        touch: &ContactKinematics<T>,
        carry: &FrameRotation<T>,
        _: Vec3<T>,
        pressed: T,
        dt: f64,
    ) -> TangentialStep<T> {
        let limit = self.friction * touch.effective_radius_m * pressed;
        let rolling = rolling(touch);
        let speed = rolling.square().sqrt();
        let slow =
            limit.scale(dt / ConstantMoment::FRACTION) / touch.effective_rolling_inertia_kg_m2;
        let coefficient = speed.if_positive(limit.if_positive(limit / speed.maximum(slow)));
        damped(carry.to_end(rolling * coefficient))
    }

    /// None: the viscous part scales with the time step and is stable for any.
    #[inline(always)]
    fn linearised(&self, _: &NormalResponse<T>, touch: &ContactKinematics<T>) -> [T; 2] {
        let none = touch.effective_radius_m.zero();
        [none, none]
    }
}

impl<T: Number> RollingFriction<T> for ElasticPlastic<T> {
    const REMEMBERS: bool = true;

    #[inline(always)]
    fn roll(
        &self,
        normal_response: &NormalResponse<T>,
        touch: &ContactKinematics<T>,
        carry: &FrameRotation<T>,
        before: Vec3<T>,
        pressed: T,
        dt: f64,
    ) -> TangentialStep<T> {
        let rolling = rolling(touch);
        let [stiffness, damping] = self.linearised(normal_response, touch);
        let arm = self.friction * touch.effective_radius_m;
        let stiffness_before = (normal_response.normal_n_m[0] * arm * arm).scale(STIFFNESS);
        let one = touch.effective_radius_m.zero().plus(1.0);
        coulomb_return_map(
            carry,
            before,
            rolling.scale(dt),
            [stiffness_before, stiffness],
            normal_response.stiffness_ratio.minimum(one),
            arm * pressed,
            rolling * damping,
        )
    }

    #[inline(always)]
    fn linearised(
        &self,
        normal_response: &NormalResponse<T>,
        touch: &ContactKinematics<T>,
    ) -> [T; 2] {
        let arm = self.friction * touch.effective_radius_m;
        let stiffness = (normal_response.normal_n_m[1] * arm * arm).scale(STIFFNESS);
        let critical = (stiffness * touch.effective_rolling_inertia_kg_m2)
            .sqrt()
            .scale(2.0);
        [stiffness, self.damping_ratio * critical]
    }
}

/// Ratio of k_r to k_n mu_r^2 R*^2 (Ai et al. 2011, after Jiang et al. 2005).
const STIFFNESS: f64 = 2.25;

/// Relative spin across the normal, in the middle of the step, rad/s.
#[inline(always)]
fn rolling<T: Number>(touch: &ContactKinematics<T>) -> Vec3<T> {
    touch.spin_rad_s - touch.middle * touch.spin_rad_s.dot(touch.middle)
}

/// A damper without a spring.
#[inline(always)]
fn damped<T: Number>(damping: Vec3<T>) -> TangentialStep<T> {
    let none = damping.0.zero();
    TangentialStep {
        spring: Vec3(none, none, none),
        force: Vec3(none, none, none),
        damping,
        stored_j: none,
        lost_j: none,
    }
}
