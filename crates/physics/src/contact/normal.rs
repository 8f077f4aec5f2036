//! What a normal law gives.

use super::kinematics::ContactKinematics;
use super::pair_parameters::PairParameters;
use crate::number::Number;

/// Result of a normal law for a contact at its overlap, now and a step before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalResponse<T = f64> {
    /// Elastic force with [attraction](NormalLaw::attraction_n), N.
    pub elastic_n: T,
    /// Elastic energy, J.
    pub energy_j: T,
    /// Tangent stiffness along the normal, before the step and now, N/m.
    pub normal_n_m: [T; 2],
    /// Stiffness of the tangential spring, before the step and now, N/m.
    pub tangential_n_m: [T; 2],
    /// Ratio of the stiffness before the step to that now; 0 if there is no contact now.
    pub stiffness_ratio: T,
    /// Coefficient of normal damping, N s/m.
    pub normal_damping_n_s_m: T,
    /// Coefficient of tangential damping, N s/m.
    pub tangential_damping_n_s_m: T,
}

/// A law for the normal force, and the quantities that friction needs from it.
pub trait NormalLaw<T: Number> {
    /// Whether it attracts, by [`Self::attraction_n`]: other laws pay nothing for it.
    const ATTRACTS: bool = false;

    /// The contact now and, at the overlap of its history, a step of `dt`, s, before.
    fn evaluate(
        &self,
        touch: &ContactKinematics<T>,
        overlap_before_m: T,
        dt: f64,
    ) -> NormalResponse<T>;

    /// Force with which the ends attract each other while they touch, N: part of the elastic force,
    /// but it does not press them.
    #[inline(always)]
    fn attraction_n(&self, touch: &ContactKinematics<T>) -> T {
        touch.overlap_m.zero()
    }

    /// That force of ends that just touch, N.
    #[inline(always)]
    fn attraction_at_touch_n(&self, touch: &ContactKinematics<T>) -> T {
        touch.overlap_m.zero()
    }

    /// Energy of the attraction of ends that touch, J, part of the energy of the contact: below 0.
    /// That of an attraction that does not depend on the overlap, unless a law has its own.
    #[inline(always)]
    fn adhesion_j(&self, touch: &ContactKinematics<T>) -> T {
        -(self.attraction_n(touch) * touch.overlap_m)
    }

    /// Damping and friction of the pair.
    fn parameters(&self) -> &PairParameters<T>;
}

/// Quantities that the choice of the time step needs from a law besides forces.
pub trait ImpactLaw {
    /// Largest fraction of its own limit at which an impact of one sphere is resolved so well that
    /// the errors of its energy, over the kinetic energy, and of its restitution are at most
    /// `accuracy`, 0.04 or less: for any restitution, and any moment within a step at which the ends
    /// meet.
    fn impact_fraction(&self, accuracy: f64) -> f64;

    /// The same for flat landings of clumps at the usual accuracy: all of the energy of a body is in
    /// them, and is to be kept to 1e-3.
    fn landing_fraction(&self) -> f64;

    /// Tangent stiffness along the normal, N/m, at an overlap, m, above 0, with an effective
    /// radius, m.
    fn normal_n_m(&self, overlap_m: f64, effective_radius_m: f64) -> f64;

    /// Largest overlap at which the tangent stiffness is at most this, N/m, with an effective
    /// radius, m; infinite if no contact is stiffer.
    fn overlap_of_stiffness_m(&self, stiffness_n_m: f64, effective_radius_m: f64) -> f64;

    /// Largest overlap of an impact at a speed, m/s, without damping, m: damping reduces it.
    fn overlap_at_impact_m(&self, effective_radius_m: f64, mass_kg: f64, speed_m_s: f64) -> f64;

    /// Largest force with which ends that touch attract each other, N, with an effective radius, m;
    /// 0 without attraction.
    fn largest_attraction_n(&self, effective_radius_m: f64) -> f64;
}
