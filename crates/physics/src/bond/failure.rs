//! Failure of bonds: stresses from their forces and moments, compared with strengths.
//!
//! Sources: MUSEN's elastic solid bond (normal and shear strength); Platzer 2022, eqs. 11-13 (von
//! Mises); the text books (Mohr and Coulomb).
//!
//! MUSEN's normal force is a magnitude. Here it has its sign: bending pulls one edge of the section
//! and presses the opposite one, and each of the two edges has its own strength. Platzer 2022, eqs.
//! 11 and 12, uses strains of the bond; here the same stresses follow from its forces and moments,
//! each with its own stiffness.

use std::f64::consts::PI;

use super::BondLoad;
use super::criteria::{COUNT, squared, strengths};
use crate::number::Number;

pub use super::causes::CauseCounts;
pub use super::criteria::Cause;
pub use super::stresses::{Criteria, EquivalentStress, Stresses, stresses};

/// Factors on strengths. None is below 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Scatter from bond to bond, for all strengths.
    pub scatter: f64,
    /// Strengthening by the strain rate, 1 or more, for all strengths except the compressive one.
    pub rate: f64,
}

impl Factors {
    /// Strengths with scatter that do not depend on the strain rate.
    pub fn scattered(scatter: f64) -> Self {
        Self { scatter, rate: 1.0 }
    }

    /// The factor on a strength that rises with the strain rate, or does not.
    #[inline(always)]
    pub(super) fn on(self, rises: bool) -> f64 {
        self.scatter * if rises { self.rate } else { 1.0 }
    }
}

/// Whether any criterion has a strength that a stress can reach.
pub fn has_strength(criteria: &Criteria) -> bool {
    let mut strengths = strengths(criteria).into_iter();
    strengths.any(|(strength_pa, _)| strength_pa.is_finite())
}

/// The smallest strength against anything but compression, Pa; infinite if there is none.
pub fn smallest_strength_pa(criteria: &Criteria) -> f64 {
    let strengths = Cause::ALL.into_iter().zip(strengths(criteria));
    let others = strengths.filter(|(cause, _)| *cause != Cause::Compression);
    others.fold(f64::INFINITY, |least, (_, (strength_pa, _))| {
        least.min(strength_pa)
    })
}

/// Utilisation: the largest ratio of stress to strength; the bond breaks at 1.
///
/// As neither the stresses nor the strengths depend on the factors, a loop over bonds may skip a
/// factor that is never below 1, and compute it only for the few bonds that would break without it.
#[inline(always)]
pub fn utilisation(criteria: &Criteria, stresses: &Stresses, factors: Factors) -> f64 {
    let used = fractions(criteria, stresses);
    let used = used.map(|(used, rises)| fraction(used, factors.on(rises)));
    used.into_iter().fold(0.0, f64::max)
}

/// The criterion with the largest utilisation.
pub fn cause(criteria: &Criteria, stresses: &Stresses, factors: Factors) -> Cause {
    let mut most = (f64::NEG_INFINITY, Cause::Tension);
    for (cause, (used, rises)) in Cause::ALL.into_iter().zip(fractions(criteria, stresses)) {
        // Without rate strengthening, the utilisation is higher by this factor.
        let used = if rises { used } else { used * factors.rate };
        if used > most.0 {
            most = (used, cause);
        }
    }
    most.1
}

/// Ratios of stress to strength, and whether the strain rate increases the strength.
#[inline(always)]
pub(super) fn fractions(criteria: &Criteria, stresses: &Stresses) -> [(f64, bool); COUNT] {
    let (squared, strengths) = (squared(criteria, stresses), strengths(criteria));
    std::array::from_fn(|k| {
        let (strength_pa, rises) = strengths[k];
        (fraction(squared[k].sqrt(), strength_pa), rises)
    })
}

/// Ratio of a stress to a strength, neither below 0; a stress of 0 with a strength of 0 gives 0.
#[inline(always)]
fn fraction(stress: f64, strength: f64) -> f64 {
    if stress == 0.0 {
        0.0
    } else {
        stress / strength
    }
}

/// Largest factor that [`Screen`] uses: finite, so that 0 times it is 0.
const LARGEST: f64 = 1e300;

/// Factor by which [`Screen`] overestimates bending at the edges, and shear beside friction. If
/// axial force and bending (or shear) nearly cancel, their rounding errors, a few 1e-16 of either,
/// are large compared with the difference.
const CANCELLATION: f64 = 1.0 + 1e-14;

/// Finds the few bonds that may have reached their strength, without a square root or a division.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screen {
    criteria: Criteria,
    /// Inverse squares of the strengths, 1/Pa2; [`LARGEST`] for strengths of 0.
    per_strength_squared: [f64; COUNT],
}

impl Screen {
    /// For these strengths.
    pub fn new(criteria: &Criteria) -> Self {
        let per_squared = |(strength, _): (f64, bool)| (1.0 / (strength * strength)).min(LARGEST);
        Self {
            criteria: *criteria,
            per_strength_squared: strengths(criteria).map(per_squared),
        }
    }

    /// Square of the utilisation times the factor (pi r^3)^2, and this factor: stresses times pi
    /// r^3 are F r + 4 M and S r + 2 T. The criterion of Mohr and Coulomb counts only if
    /// `FRICTIONAL`: without it, not even its zeros are computed.
    #[inline(always)]
    pub fn utilisation_and_factor<T: Number, const FRICTIONAL: bool>(
        &self,
        load: &BondLoad<T>,
        radius_m: T,
    ) -> [T; 2] {
        let of_shear = if FRICTIONAL { CANCELLATION } else { 1.0 };
        let stresses = Stresses {
            axial_pa: load.normal_n * radius_m,
            bending_pa: load.bending_n_m.scale(4.0 * CANCELLATION),
            shear_pa: (load.shear_n * radius_m).scale(of_shear),
            torsion_pa: load.torsion_n_m.scale(2.0 * of_shear),
        };
        let squared = squared(&self.criteria, &stresses);
        let used: [T; COUNT] =
            std::array::from_fn(|k| squared[k].scale(self.per_strength_squared[k]));
        let count = if FRICTIONAL {
            COUNT
        } else {
            Cause::MohrCoulomb as usize
        };
        let used = used[1..count]
            .iter()
            .fold(used[0], |most, &one| most.maximum(one));
        let volume = (radius_m * radius_m * radius_m).scale(PI);
        [used, volume * volume]
    }
}
