//! Viscous damping of bonds: four coefficients, one for each mode, from any model, and the
//! resulting forces. The models are in `damping_models`, one per file.
//!
//! Sources: Chen et al. 2022, eqs. 9 and 10; Platzer 2022, eqs. 7, 9 and 10.

use super::stiffness::Stiffness;
use crate::number::{Number, Vec3};
use nalgebra::Vector3;
use std::ops::Add;

/// Damping force or moment per relative speed at the contact point, mode by mode.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct DampingCoefficients<T = f64> {
    /// Normal, N s/m.
    pub normal: T,
    /// Shear, N s/m.
    pub shear: T,
    /// Torsion, N m s/rad.
    pub torsion: T,
    /// Bending, N m s/rad.
    pub bending: T,
}

impl From<DampingCoefficients> for [f64; 4] {
    /// Normal, shear, torsion, bending.
    fn from(all: DampingCoefficients) -> Self {
        [all.normal, all.shear, all.torsion, all.bending]
    }
}

impl Add for DampingCoefficients {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            normal: self.normal + other.normal,
            shear: self.shear + other.shear,
            torsion: self.torsion + other.torsion,
            bending: self.bending + other.bending,
        }
    }
}

/// Reduced mass and moment of inertia of the two ends of a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReducedInertia {
    /// m_a m_b / (m_a + m_b), kg.
    pub mass_kg: f64,
    /// I_a I_b / (I_a + I_b), kg m^2.
    pub inertia_kg_m2: f64,
}

/// Reduced mass and inertia of two ends, from inverse masses and inverse moments of inertia: 0 for
/// a held end. Between two held ends both are 0, so there is no damping.
#[inline(always)]
pub fn reduced(inverse_masses: [f64; 2], inverse_inertias: [f64; 2]) -> ReducedInertia {
    let reduced = |[a, b]: [f64; 2]| if a + b > 0.0 { 1.0 / (a + b) } else { 0.0 };
    ReducedInertia {
        mass_kg: reduced(inverse_masses),
        inertia_kg_m2: reduced(inverse_inertias),
    }
}

/// A model for the damping coefficients of a bond.
pub trait DampingModel {
    /// Coefficients of a bond of this stiffness between ends of these reduced masses.
    fn coefficients(&self, stiffness: &Stiffness, reduced: &ReducedInertia) -> DampingCoefficients;
}

/// Motion of an end of a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndMotion {
    /// Velocity of the centre, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Spin, rad/s.
    pub spin_rad_s: Vector3<f64>,
}

/// Damping of one bond or several at once, with the vector `apart` from the first end to the
/// second, m, and ends of these velocities, m/s, and spins, rad/s: force on the second end, N, and
/// torques on both, N m. The contact point divides the length in the same ratio as the `levers_m`
/// divide the initial one.
///
/// Damping exerts no net moment on the bond, gives no force while it moves as a rigid body, and
/// never adds energy.
#[inline(always)]
pub fn resistance<T: Number>(
    coefficients: &DampingCoefficients<T>,
    levers_m: [T; 2],
    apart: Vec3<T>,
    motions: [[Vec3<T>; 2]; 2],
) -> (Vec3<T>, [Vec3<T>; 2]) {
    let moved = relative_motion(levers_m, apart, motions);
    let per_square = apart.square().inverse();
    let DampingCoefficients {
        normal,
        shear,
        torsion,
        bending,
    } = *coefficients;
    let force = split(normal, shear, moved.velocity_m_s, apart, per_square);
    let moment = split(torsion, bending, moved.spin_rad_s, apart, per_square);
    let torque = apart.cross(force);
    let on_a = torque * moved.share;
    (-force, [moment + on_a, torque - on_a - moment])
}

/// Motion of the second end of a bond relative to the first at the contact point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeMotion<T> {
    /// Part of the bond between its first end and the contact point.
    pub share: T,
    /// m/s.
    pub velocity_m_s: Vec3<T>,
    /// rad/s.
    pub spin_rad_s: Vec3<T>,
}

/// The relative motion of two ends with these velocities, m/s, and spins, rad/s, which are `apart`,
/// m; the contact point divides the bond like the levers.
#[inline(always)]
pub fn relative_motion<T: Number>(
    [lever_a, lever_b]: [T; 2],
    apart: Vec3<T>,
    [[velocity_a, spin_a], [velocity_b, spin_b]]: [[Vec3<T>; 2]; 2],
) -> RelativeMotion<T> {
    let share = lever_a / (lever_a + lever_b);
    let spin_rad_s = spin_b - spin_a;
    let turning = spin_b - spin_rad_s * share;
    RelativeMotion {
        share,
        velocity_m_s: velocity_b - velocity_a - turning.cross(apart),
        spin_rad_s,
    }
}

/// `along` times the part of a vector along a bond plus `across` times the rest; `per_square` is
/// one over the square of the length of the bond.
#[inline(always)]
fn split<T: Number>(
    along: T,
    across: T,
    vector: Vec3<T>,
    apart: Vec3<T>,
    per_square: T,
) -> Vec3<T> {
    vector * across + apart * ((along - across) * vector.dot(apart) * per_square)
}
