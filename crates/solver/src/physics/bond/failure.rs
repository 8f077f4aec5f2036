//! When a bond breaks: stresses from its own forces and moments against strengths.
//!
//! Sources: MUSEN's elastic solid bond (normal and shear strength); Platzer 2022, eqs. 11-13 (von Mises).
//!
//! MUSEN's normal force is a magnitude: with `compressive`, pressing and pulling count alike. The thesis' eqs. 11 and 12 speak of strains of
//! the bond; here the same stresses come from its forces and moments, each with its own stiffness. A round bond: A = pi r^2, I = A r^2 / 4, J = 2 I.

use super::BondLoad;
use crate::physics::number::Number;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Strengths of a bond, none below 0. An infinite strength is not asked for; of a strength of 0 any load takes more than all, and none takes nothing.
/// Several may act together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criteria {
    /// MUSEN's normal strength: largest normal stress of axial force and bending, Pa.
    pub tension_pa: f64,
    /// MUSEN's shear strength: largest shear stress of shear force and torsion, Pa.
    pub shear_pa: f64,
    /// The thesis' equivalent stress, in which the axial part counts only while it pulls, Pa.
    pub von_mises_pa: f64,
    /// Whether MUSEN's normal strength also holds while the bond is pressed.
    pub compressive: bool,
}

/// Largest stresses in the section of a bond, each from one mode.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stresses {
    /// F_n / A, tension positive, Pa.
    pub axial_pa: f64,
    /// M_ben r / I, Pa. Not negative.
    pub bending_pa: f64,
    /// F_s / A, Pa. Not negative.
    pub shear_pa: f64,
    /// M_tor r / J, Pa. Not negative.
    pub torsion_pa: f64,
}

/// Which criterion a bond failed by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Normal strength, while pulled.
    Tension,
    /// Normal strength, while pressed.
    Compression,
    /// Shear strength.
    Shear,
    /// Equivalent stress.
    VonMises,
}

impl Cause {
    /// Its name in results: `von_mises`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tension => "tension",
            Self::Compression => "compression",
            Self::Shear => "shear",
            Self::VonMises => "von_mises",
        }
    }
}

/// Stresses in a bond of this radius under this load.
#[inline(always)]
pub fn stresses(load: &BondLoad, radius_m: f64) -> Stresses {
    let per_area = 1.0 / (PI * radius_m * radius_m);
    // 1 / (A r), without a second division.
    let per_area_radius = PI * radius_m * per_area * per_area;
    Stresses {
        axial_pa: load.normal_n * per_area,
        bending_pa: 4.0 * load.bending_n_m * per_area_radius,
        shear_pa: load.shear_n * per_area,
        torsion_pa: 2.0 * load.torsion_n_m * per_area_radius,
    }
}

/// Largest share of a strength that is used; the bond breaks at 1.
///
/// `strength_factor` multiplies all strengths: scatter times rate strengthening. As neither the stresses nor the strengths depend on it, a loop
/// over bonds may leave out a factor that is never below 1, and compute it for the few bonds that would break without it.
#[inline(always)]
pub fn utilisation(criteria: &Criteria, stresses: &Stresses, strength_factor: f64) -> f64 {
    let [normal, shear, von_mises] = shares(criteria, stresses);
    share(normal.max(shear).max(von_mises), strength_factor)
}

/// Largest number by which [`Screen`] multiplies: finite, so that 0 times it is 0.
const LARGEST: f64 = 1e300;

/// Finds the few bonds that may have reached their strength, without a root or a division.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screen {
    /// One over the square of each strength: normal, shear, von Mises, 1/Pa2; [`LARGEST`] for strengths of 0.
    per_strength_squared: [f64; 3],
    compressive: bool,
}

impl Screen {
    /// For these strengths.
    pub fn new(criteria: &Criteria) -> Self {
        let strengths = [
            criteria.tension_pa,
            criteria.shear_pa,
            criteria.von_mises_pa,
        ];
        Self {
            per_strength_squared: strengths
                .map(|strength| (1.0 / (strength * strength)).min(LARGEST)),
            compressive: criteria.compressive,
        }
    }

    /// Square of the utilisation, but for the factor (pi r^3)^2 that is given beside it: stresses times pi r^3 are F r + 4 M and S r + 2 T.
    #[inline(always)]
    pub fn used_and_factor<T: Number>(&self, load: &BondLoad<T>, radius_m: T) -> [T; 2] {
        let (bending, torsion) = (load.bending_n_m.times(4.0), load.torsion_n_m.times(2.0));
        let axial = load.normal_n * radius_m;
        let pulled = axial.if_positive(axial) + bending;
        let normal = if self.compressive {
            axial.larger(-axial) + bending
        } else {
            axial.if_positive(pulled)
        };
        let shear = load.shear_n * radius_m + torsion;
        let [by_normal, by_shear, by_von_mises] = self.per_strength_squared;
        let used = (normal * normal)
            .times(by_normal)
            .larger((shear * shear).times(by_shear))
            .larger((pulled * pulled + (shear * shear).times(3.0)).times(by_von_mises));
        let volume = (radius_m * radius_m * radius_m).times(PI);
        [used, volume * volume]
    }
}

/// The criterion of which the largest share is used.
pub fn cause(criteria: &Criteria, stresses: &Stresses) -> Cause {
    let [normal, shear, von_mises] = shares(criteria, stresses);
    if normal >= shear && normal >= von_mises {
        if stresses.axial_pa >= 0.0 {
            Cause::Tension
        } else {
            Cause::Compression
        }
    } else if shear >= von_mises {
        Cause::Shear
    } else {
        Cause::VonMises
    }
}

/// Normal, shear and equivalent stress, each over its strength.
#[inline(always)]
fn shares(criteria: &Criteria, stresses: &Stresses) -> [f64; 3] {
    let counts = criteria.compressive || stresses.axial_pa > 0.0;
    let normal = if counts {
        stresses.axial_pa.abs() + stresses.bending_pa
    } else {
        0.0
    };
    let shear = stresses.shear_pa + stresses.torsion_pa;
    let pulled = stresses.axial_pa.max(0.0) + stresses.bending_pa;
    let von_mises = (pulled * pulled + 3.0 * shear * shear).sqrt();
    [
        share(normal, criteria.tension_pa),
        share(shear, criteria.shear_pa),
        share(von_mises, criteria.von_mises_pa),
    ]
}

/// A stress over a strength, neither below 0; nothing of no strength is 0.
#[inline(always)]
fn share(stress: f64, strength: f64) -> f64 {
    if stress == 0.0 {
        0.0
    } else {
        stress / strength
    }
}
