//! Rolling friction: a moment against rolling. Twisting about the normal is free.
//!
//! Rolling w_t is the part of the relative spin across the normal; the moment is mu_r R* N at most.
//!
//! - Constant moment (type A of Ai et al. 2011): against w_t, whatever its size. Slow rolling meets
//!   a viscous moment instead, which would take a [small share](ConstantMoment::SHARE) of the
//!   rolling in a step: so a body at rest neither jitters nor is turned back. It does not hold
//!   either: a constant torque below the limit makes it creep, more slowly as the time step is
//!   smaller.
//! - Elastic-plastic spring and dashpot (type C of Ai et al. 2011): k_r = 2.25 k_n mu_r^2 R*^2 with
//!   k_n the tangent normal stiffness, slipping at the limit; c_r = 2 eta sqrt(J k_r) with J the
//!   reduced inertia about the contact point. It holds a body at rest. Unlike there, damping counts
//!   in the limit, so that it fades out instead of jumping to 0 when the spring begins to slip; and
//!   the spring is treated as the tangential one when the load changes.

use super::NormalResponse;
use super::kinematics::{ContactKinematics, FrameRotation};
use super::slider::{TangentialStep, coulomb_return_map};
use crate::physics::number::{Number, Vec3};
use serde::Serialize;

/// What becomes of rolling.
pub trait RollingFriction<T: Number> {
    /// Whether there is anything to remember: else springs and damping are nothing.
    const REMEMBERS: bool;

    /// The spring after a step that began with the elongation `before`, in the axes of that moment,
    /// pressed by the normal force `pressed`, N.
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
    /// mu_r, of R*.
    pub friction: T,
}

/// Elastic-plastic spring and dashpot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ElasticPlastic<T = f64> {
    /// mu_r, of R*.
    pub friction: T,
    /// eta, share of critical damping: 0.3 in Ai et al. 2011.
    pub damping_ratio: T,
}

impl ConstantMoment {
    /// Slow rolling loses this share of itself in a step, reckoned with the inertia about the
    /// contact point. That is 3.5 times a sphere's inertia about its centre: a dozen contacts with
    /// equal spheres, each with half of it, still take no more than all of its spin.
    pub const FRACTION: f64 = 1.0 / 21.0;
}

impl ConstantMoment {
    /// The same for as many contacts at once as a number stands for.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T) -> ConstantMoment<T> {
        ConstantMoment {
            friction: all(self.friction),
        }
    }
}

impl ElasticPlastic {
    /// The same for as many contacts at once as a number stands for.
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

    /// Nothing: its viscous part follows the time step and is stable at any.
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

/// k_r over k_n mu_r^2 R*^2 (Ai et al. 2011, after Jiang et al. 2005).
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
