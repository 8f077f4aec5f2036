//! Structural damping: a fraction of what a bond carries resists its relative motion, mode by mode.
//!
//! F_d = -gamma |F| v / sqrt(v^2 + v_0^2), M_d = -gamma |M| w / sqrt(w^2 + w_0^2), with the
//! relative velocity v and spin w at the contact point: along the bond and across it, about it and
//! across it.
//!
//! The rule that Chen et al. 2022, eqs. 11 and 12, apply to the motion of particles brakes free
//! flight and carries a part of the weight. This one acts on the relative motion of two ends: what
//! moves as a rigid body is not damped, and momentum and angular momentum are untouched. A mode
//! loses the same fraction of its amplitude in every cycle, whatever its frequency (but see below):
//! it moves outwards with the stiffness (1 + gamma) k and back with (1 - gamma) k, so that half a
//! cycle multiplies its speed by sqrt((1 - gamma)/(1 + gamma)).
//!
//! **Deviation.** Chen et al. have the sign of the motion, which is v_0 = 0. Such a force jumps
//! where the motion reverses, carries a part of a steady load and leaves no order of convergence in
//! the step. Here v_0 = epsilon omega |F|/k, with the frequency omega of the ends on the bond alone
//! and its stiffness k: near the reversal the force grows with the motion, and what is under a
//! steady load comes to rest. Modes slower than epsilon omega are damped less, in proportion to
//! their frequency.

use crate::bond::BondLoad;
use crate::bond::damping::{DampingCoefficients, EndMotion, relative_motion};
use crate::bond::stiffness::Stiffness;
use crate::number::Vec3;
use nalgebra::Vector3;

/// epsilon: over the frequency of a bond, the slowest that is damped in full.
pub const SMOOTHING: f64 = 0.03;

/// A bond with structural damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StructuralDamping {
    /// Fraction of the load that resists.
    pub gamma: f64,
    /// Of the bond.
    pub stiffness: Stiffness,
    /// Circular frequency of the two ends on the normal stiffness of the bond, rad/s.
    pub frequency_rad_s: f64,
}

impl StructuralDamping {
    /// Coefficients with which a dashpot resists as the damping does, under this load and with this
    /// motion of the ends, which are `apart`, m.
    pub fn coefficients(
        &self,
        load: &BondLoad,
        apart: &Vector3<f64>,
        ends: &[EndMotion; 2],
    ) -> DampingCoefficients {
        let motions = ends.map(|end| [Vec3::from(end.velocity_m_s), Vec3::from(end.spin_rad_s)]);
        let moved = relative_motion(self.stiffness.levers_m, Vec3::from(*apart), motions);
        let c = apart.normalize();
        let speeds = |motion: Vector3<f64>| {
            let along = motion.dot(&c);
            [along.abs(), (motion - c * along).norm()]
        };
        let [opening_m_s, sliding_m_s] = speeds(moved.velocity_m_s.into());
        let [twisting_rad_s, bending_rad_s] = speeds(moved.spin_rad_s.into());
        let k = &self.stiffness;
        DampingCoefficients {
            normal: self.coefficient(k.normal, load.normal_n.abs(), opening_m_s),
            shear: self.coefficient(k.shear, load.shear_n, sliding_m_s),
            torsion: self.coefficient(k.torsion, load.torsion_n_m.abs(), twisting_rad_s),
            bending: self.coefficient(k.bending, load.bending_n_m, bending_rad_s),
        }
    }

    /// The largest that the coefficients can be: those of ends at rest under a load.
    pub fn largest_coefficients(&self) -> DampingCoefficients {
        let k = &self.stiffness;
        let [normal, shear, torsion, bending] =
            [k.normal, k.shear, k.torsion, k.bending].map(|k| self.coefficient(k, 1.0, 0.0));
        DampingCoefficients {
            normal,
            shear,
            torsion,
            bending,
        }
    }

    fn coefficient(&self, stiffness: f64, load: f64, speed: f64) -> f64 {
        let slowest = SMOOTHING * self.frequency_rad_s * load;
        let speed = (stiffness * speed).hypot(slowest);
        if speed > 0.0 {
            self.gamma * stiffness * load / speed
        } else {
            0.0
        }
    }
}
