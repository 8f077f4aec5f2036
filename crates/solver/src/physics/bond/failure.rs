//! When a bond breaks: stresses from its own forces and moments against strengths.
//!
//! Sources: MUSEN's elastic solid bond (normal and shear strength); Platzer 2022, eqs. 11-13 (von
//! Mises).
//!
//! MUSEN's normal force is a magnitude. Here it has its sign: bending pulls one edge of the section
//! and presses the opposite one, and each of the two edges has a strength of its own. Platzer 2022,
//! eqs. 11 and 12, speaks of strains of the bond; here the same stresses come from its forces and
//! moments, each with its own stiffness. A round bond: A = pi r^2, I = A r^2 / 4, J = 2 I.

use super::BondLoad;
use crate::physics::number::Number;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::fmt;

/// Strengths of a bond, none below 0. An infinite strength is not asked for; of a strength of 0 any
/// load takes more than all, and none takes nothing. Several may act together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Criteria {
    /// Largest stress at the tensile edge: F_n / A + M_ben r / I, tension positive, Pa.
    pub tension_pa: f64,
    /// Largest stress at the pressed edge: -F_n / A + M_ben r / I, Pa.
    pub compression_pa: f64,
    /// MUSEN's shear strength: largest shear stress of shear force and torsion, Pa.
    pub shear_pa: f64,
    /// Equivalent stress of Platzer 2022, eq. 13, whose axial part counts only while it pulls, Pa.
    pub von_mises_pa: f64,
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

impl Stresses {
    /// At the edge that is pulled most; below 0 if the whole section is pressed, Pa.
    #[inline(always)]
    pub fn tensile_edge_pa(&self) -> f64 {
        self.bending_pa + self.axial_pa
    }

    /// At the edge that is pressed most; below 0 if the whole section is pulled, Pa.
    #[inline(always)]
    pub fn pressed_edge_pa(&self) -> f64 {
        self.bending_pa - self.axial_pa
    }
}

/// Which criterion a bond failed by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cause {
    /// Strength at the tensile edge.
    Tension,
    /// Strength at the pressed edge.
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

/// How many bonds failed by each criterion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct CauseCounts {
    /// At the tensile edge.
    pub tension: u64,
    /// At the pressed edge.
    pub compression: u64,
    /// By shear strength.
    pub shear: u64,
    /// By equivalent stress.
    pub von_mises: u64,
}

impl CauseCounts {
    /// Counts one more bond.
    pub fn count(&mut self, cause: Cause) {
        *match cause {
            Cause::Tension => &mut self.tension,
            Cause::Compression => &mut self.compression,
            Cause::Shear => &mut self.shear,
            Cause::VonMises => &mut self.von_mises,
        } += 1;
    }
}

impl fmt::Display for CauseCounts {
    /// Those that are not 0: `23 in tension, 2 in shear`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.tension, "in tension"),
            (self.compression, "in compression"),
            (self.shear, "in shear"),
            (self.von_mises, "by equivalent stress"),
        ];
        let said = counts.iter().filter(|(count, _)| *count > 0);
        let said: Vec<String> = said.map(|(count, how)| format!("{count} {how}")).collect();
        f.write_str(&said.join(", "))
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

/// What raises strengths. None is below 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factors {
    /// Scatter from bond to bond: of all strengths.
    pub scatter: f64,
    /// Strengthening by the rate of strain, 1 or more: of all strengths but that in compression.
    pub rate: f64,
}

impl Factors {
    /// Strengths that scatter, and do not depend on the rate.
    pub fn scattered(scatter: f64) -> Self {
        Self { scatter, rate: 1.0 }
    }
}

/// Largest share of a strength that is used; the bond breaks at 1.
///
/// As neither the stresses nor the strengths depend on the factors, a loop over bonds may leave out
/// a factor that is never below 1, and compute it for the few bonds that would break without it.
#[inline(always)]
pub fn utilisation(criteria: &Criteria, stresses: &Stresses, factors: Factors) -> f64 {
    let Shares {
        tension,
        compression,
        shear,
        von_mises,
    } = Shares::of(criteria, stresses);
    let by_rate = tension.max(shear).max(von_mises);
    share(by_rate, factors.scatter * factors.rate).max(share(compression, factors.scatter))
}

/// The criterion of which the largest share is used.
pub fn cause(criteria: &Criteria, stresses: &Stresses, factors: Factors) -> Cause {
    let Shares {
        tension,
        compression,
        shear,
        von_mises,
    } = Shares::of(criteria, stresses);
    // The rate does not strengthen in compression: over the others' strengths it is more by so
    // much.
    let compression = compression * factors.rate;
    if tension >= compression && tension >= shear && tension >= von_mises {
        Cause::Tension
    } else if compression >= shear && compression >= von_mises {
        Cause::Compression
    } else if shear >= von_mises {
        Cause::Shear
    } else {
        Cause::VonMises
    }
}

/// Stresses over strengths.
struct Shares {
    tension: f64,
    compression: f64,
    shear: f64,
    von_mises: f64,
}

impl Shares {
    #[inline(always)]
    fn of(criteria: &Criteria, stresses: &Stresses) -> Self {
        let shear = stresses.shear_pa + stresses.torsion_pa;
        let pulled = stresses.axial_pa.max(0.0) + stresses.bending_pa;
        let von_mises = (pulled * pulled + 3.0 * shear * shear).sqrt();
        Self {
            tension: share(stresses.tensile_edge_pa().max(0.0), criteria.tension_pa),
            compression: share(stresses.pressed_edge_pa().max(0.0), criteria.compression_pa),
            shear: share(shear, criteria.shear_pa),
            von_mises: share(von_mises, criteria.von_mises_pa),
        }
    }
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

/// Largest number by which [`Screen`] multiplies: finite, so that 0 times it is 0.
const LARGEST: f64 = 1e300;

/// By how much [`Screen`] overrates bending at the edges. Where axial force and bending nearly
/// cancel, their rounding, a few 1e-16 of either, is large beside what is left.
const CANCELLATION: f64 = 1.0 + 1e-14;

/// Finds the few bonds that may have reached their strength, without a root or a division.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Screen {
    /// One over the square of each strength: tension, compression, shear, von Mises, 1/Pa2;
    /// [`LARGEST`] for strengths of 0.
    per_strength_squared: [f64; 4],
}

impl Screen {
    /// For these strengths.
    pub fn new(criteria: &Criteria) -> Self {
        let strengths = [
            criteria.tension_pa,
            criteria.compression_pa,
            criteria.shear_pa,
            criteria.von_mises_pa,
        ];
        Self {
            per_strength_squared: strengths
                .map(|strength| (1.0 / (strength * strength)).min(LARGEST)),
        }
    }

    /// Square of the utilisation, but for the factor (pi r^3)^2 that is given beside it: stresses
    /// times pi r^3 are F r + 4 M and S r + 2 T.
    #[inline(always)]
    pub fn used_and_factor<T: Number>(&self, load: &BondLoad<T>, radius_m: T) -> [T; 2] {
        let (bending, torsion) = (load.bending_n_m.scale(4.0), load.torsion_n_m.scale(2.0));
        let axial = load.normal_n * radius_m;
        let at_edges = bending.scale(CANCELLATION);
        let (tensile, pressed) = (at_edges + axial, at_edges - axial);
        let (tensile, pressed) = (tensile.if_positive(tensile), pressed.if_positive(pressed));
        let pulled = axial.if_positive(axial) + bending;
        let shear = load.shear_n * radius_m + torsion;
        let [by_tension, by_compression, by_shear, by_von_mises] = self.per_strength_squared;
        let used = (tensile * tensile)
            .scale(by_tension)
            .maximum((pressed * pressed).scale(by_compression))
            .maximum((shear * shear).scale(by_shear))
            .maximum((pulled * pulled + (shear * shear).scale(3.0)).scale(by_von_mises));
        let volume = (radius_m * radius_m * radius_m).scale(PI);
        [used, volume * volume]
    }
}
