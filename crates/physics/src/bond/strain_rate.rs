//! Strength that rises with the strain rate: the dynamic increase factor.
//!
//! Source: Platzer 2022, eqs. 20 and 21, after Zhou and Hao 2008.
//!
//! Printed eq. 20 lacks parentheses: it means 1 + 0.0225 (lg rate + 5.3333), which is 1 at
//! 4.64e-6/s and meets the second branch at 0.1/s. The second branch is a parabola whose lowest
//! point, 1.079 at 0.144/s, lies inside it: the factor falls slightly above 0.1/s before it rises.
//! It is left as printed. Printed eq. 21 uses the full relative velocity, which gives a rate even
//! if the bond only rotates; here it is the part along the bond.

use nalgebra::Vector3;

/// Below this rate the factor is 1, /s.
const LOWEST_1_S: f64 = 4.64e-6;
/// Above this rate the factor no longer rises, /s.
pub const HIGHEST_1_S: f64 = 50.0;
/// Start of the second branch, /s.
pub(super) const BRANCH_1_S: f64 = 0.1;

/// The rate below which Platzer 2022, section 4.5.1.8, applies no strengthening, so that the small
/// oscillations of a quasi-static test have no effect, /s.
pub const PLATZER_LOWEST_RATE_1_S: f64 = 1.1;

/// Rate of elongation of a bond along the unit vector `c` from a to b, in initial lengths per
/// second.
#[inline(always)]
pub fn elongation_rate(
    c: &Vector3<f64>,
    velocities_m_s: &[Vector3<f64>; 2],
    initial_length_m: f64,
) -> f64 {
    let [a, b] = velocities_m_s;
    (b - a).dot(c) / initial_length_m
}

/// The second branch of eq. 20, for the decimal logarithm of the rate in 1/s.
#[inline(always)]
pub fn fast_branch(lg_rate: f64) -> f64 {
    1.6 + (0.7325 * lg_rate + 1.235) * lg_rate
}

/// Ratio of dynamic to static strength at this rate of elongation: 1 while the bond gets shorter
/// and below the rate `from_1_s`, where the factor jumps to its value (from 1 to 1.652 at 1.1/s).
/// Never below 1: the printed fit gives 0.999996 at its lower end.
///
/// It costs one logarithm. The factor is never below 1, so only bonds that would break without it
/// need it.
#[inline(always)]
pub fn dynamic_increase_factor(rate_1_s: f64, from_1_s: f64) -> f64 {
    let lg = rate_1_s.clamp(LOWEST_1_S, HIGHEST_1_S).log10();
    let slow = 1.0 + 0.0225 * (lg + 5.3333);
    let factor = if rate_1_s <= BRANCH_1_S {
        slow
    } else {
        fast_branch(lg)
    };
    if rate_1_s < from_1_s {
        1.0
    } else {
        factor.max(1.0)
    }
}
