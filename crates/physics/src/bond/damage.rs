//! Damage of bonds: a cohesive zone. A bond that has reached its strength softens until its
//! fracture energy is spent, and then breaks.
//!
//! Source: Platzer 2022, 2.2.1.1 and fig. 7 (linear up to the strength, then linear down to 0); the
//! law with one number of history is that of the text books. The equivalent opening of a criterion
//! is its stress over its strength, times the opening w_e at which the strength is reached:
//!
//! w_e = s A/k, w_c = 2 G_f/s, D = w_c (w_max - w_e)/(w_max (w_c - w_e)).
//!
//! The ratio w_c/w_e is 2 G_f k/(s^2 A), so that a bond pulled or sheared apart takes G_f A
//! whatever its length. (k is the normal stiffness for tension and von Mises, the shear stiffness
//! for shear and cohesion.) Bent alone, it takes a quarter of that; twisted alone, half of it if
//! k_tor = k_s r^2/2, and less with beams; sheared by von Mises, k_n/(3 k_s) times it. Of several
//! criteria the one with the largest D counts. Strengths raised by the strain rate raise stress and
//! opening alike. Force and moments are those of the intact bond times 1 - D, except the axial
//! force of a pressed bond: a crack that closes carries pressure as before.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::criteria::{COUNT, Cause, strengths};
use super::failure::{Factors, fractions};
use super::stiffness::Stiffness;
use super::stresses::{Criteria, Stresses};

/// A bond that can be damaged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Damage {
    /// D: 0 intact, 1 broken.
    pub damage: f64,
    /// Normal stiffness of the intact bond, N/m.
    pub normal: f64,
    /// Shear stiffness of the intact bond, N/m.
    pub shear: f64,
    /// Factor on its strengths.
    pub strength_factor: f64,
}

impl Default for Damage {
    fn default() -> Self {
        Self {
            damage: 0.0,
            normal: 0.0,
            shear: 0.0,
            strength_factor: 1.0,
        }
    }
}

impl Damage {
    /// An intact bond of this stiffness whose strengths have this factor.
    pub fn none(stiffness: &Stiffness, strength_factor: f64) -> Self {
        Self {
            damage: 0.0,
            normal: stiffness.normal,
            shear: stiffness.shear,
            strength_factor,
        }
    }
}

/// Ratio of the opening at which a bond breaks to that at which it reaches its strength, for each
/// criterion in the order of [`Cause::ALL`], for a fracture energy in J/m2. A bond in which it is
/// at most 1 breaks at once: it stores more than the fracture energy. None: the bond breaks at once
/// by this criterion, which is that of pressure, or has no strength.
pub fn opening_ratios(
    criteria: &Criteria,
    fracture_energy_j_m2: f64,
    stiffness: &Stiffness,
    radius_m: f64,
    strength_factor: f64,
) -> [Option<f64>; COUNT] {
    let strengths = strengths(criteria);
    std::array::from_fn(|k| {
        let per_opening = match Cause::ALL[k] {
            Cause::Compression => return None,
            Cause::Shear | Cause::MohrCoulomb => stiffness.shear,
            Cause::Tension | Cause::VonMises => stiffness.normal,
        };
        let strength_pa = strength_factor * strengths[k].0;
        let ratio = 2.0 * fracture_energy_j_m2 * per_opening
            / (strength_pa * strength_pa * PI * radius_m * radius_m);
        strength_pa.is_finite().then_some(ratio)
    })
}

/// Damage of a bond that is opened to this multiple of the opening at its strength; `ratio`: that
/// at which it breaks.
pub fn damage_at(opening: f64, ratio: f64) -> f64 {
    if opening <= 1.0 {
        0.0
    } else if opening >= ratio {
        1.0
    } else {
        ratio * (opening - 1.0) / (opening * (ratio - 1.0))
    }
}

/// The multiple of the opening at its strength to which a bond with this damage was opened.
fn opening_of(damage: f64, ratio: f64) -> f64 {
    ratio / (ratio - damage * (ratio - 1.0))
}

/// Factor on the strengths of a damaged bond, below which none of its criteria is met: its stress,
/// 1 - D times that of the intact bond, is then below what it was at most.
pub fn screened_factor(damage: f64, ratios: &[Option<f64>; COUNT]) -> f64 {
    let openings = ratios
        .iter()
        .flatten()
        .map(|&ratio| opening_of(damage, ratio));
    (1.0 - damage) * openings.fold(f64::INFINITY, f64::min)
}

/// Growth of the damage of a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Growth {
    /// Damage afterwards; 1: the bond is broken.
    pub damage: f64,
    /// The criterion that causes it.
    pub cause: Cause,
    /// The bond breaks at once, as it stores more than its fracture energy at its strength.
    pub at_once: bool,
}

/// Growth of the damage `before` under these stresses of the intact bond. None: it does not grow.
///
/// The strengths that the strain rate raises make every opening larger by that factor.
pub fn growth(
    criteria: &Criteria,
    stresses: &Stresses,
    factors: Factors,
    ratios: &[Option<f64>; COUNT],
    before: f64,
) -> Option<Growth> {
    let mut most = None;
    let mut largest = before;
    let all = Cause::ALL.into_iter().zip(fractions(criteria, stresses));
    for ((cause, (used, rises)), ratio) in all.zip(ratios) {
        let Some(ratio) = *ratio else {
            continue;
        };
        let damage = damage_at(used / factors.on(rises), ratio);
        if damage > largest {
            largest = damage;
            let at_once = ratio <= 1.0;
            most = Some(Growth {
                damage,
                cause,
                at_once,
            });
        }
    }
    most
}

/// Utilisation of a damaged bond: of each criterion the opening now over the largest one so far,
/// and of the compressive strength the stress now. Its damage grows at 1.
pub fn utilisation_of_damaged(
    criteria: &Criteria,
    [intact, now]: [&Stresses; 2],
    factors: Factors,
    ratios: &[Option<f64>; COUNT],
    damage: f64,
) -> f64 {
    let opened = fractions(criteria, intact).into_iter().zip(ratios);
    let used = opened.zip(fractions(criteria, now));
    used.map(|(((opening, rises), ratio), (pressed, _))| match ratio {
        Some(ratio) => opening / (factors.on(rises) * opening_of(damage, *ratio)),
        None => pressed / factors.on(rises),
    })
    .fold(0.0, f64::max)
}
