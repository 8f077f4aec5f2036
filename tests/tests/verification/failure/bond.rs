//! One bond of two spheres: its section, its strengths and the stresses that break it.

use std::f64::consts::PI;

use dem_run::{State, step};

use crate::verification::scene::started;

pub(crate) const RADIUS_M: f64 = 1e-3;
pub(crate) const LENGTH_M: f64 = 3e-3;
pub(crate) const YOUNG_PA: f64 = 1e12;
pub(crate) const POISSON: f64 = 0.2;
/// eta of Chen et al. 2022, eqs. 9 and 10.
pub(crate) const DAMPING: f64 = 0.3;

/// The strengths in tension and compression, in shear, by Mohr-Coulomb and by the equivalent
/// stress, Pa.
pub(crate) const TENSION_PA: f64 = 1.0e6;
pub(crate) const COMPRESSION_PA: f64 = 1.3e6;
pub(crate) const SHEAR_PA: f64 = 0.7e6;
pub(crate) const COHESION_PA: f64 = 0.5e6;
/// Its friction angle, degrees.
pub(crate) const FRICTION_DEG: f64 = 35.0;
pub(crate) const VON_MISES_PA: f64 = 1.1e6;
/// Tensile strength that cuts Mohr-Coulomb off before its tip at c/tan(phi), Pa.
pub(crate) const CUT_OFF_PA: f64 = 0.35e6;

/// Number of steps in which a load rises to its final value. A bond breaks at the first step at
/// which it carries more than its strength: at most one load step late.
pub(crate) const STEPS: f64 = 10_000.0;
/// Relative nonlinearity of loads in displacements: bonds break at strains of about 1e-6.
pub(crate) const STRAIN: f64 = 1e-5;

/// Axial, bending, shear and torsional stress, in some proportion, Pa.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stresses {
    pub(crate) axial: f64,
    pub(crate) bending: f64,
    pub(crate) shear: f64,
    pub(crate) torsion: f64,
}

impl Stresses {
    pub(crate) fn of([axial, bending, shear, torsion]: [f64; 4]) -> Self {
        Self {
            axial,
            bending,
            shear,
            torsion,
        }
    }
}

/// A strength: its key, and its type of stress.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Criterion {
    Tension,
    Compression,
    Shear,
    MohrCoulomb,
    CutOff,
    VonMises,
}

impl Criterion {
    pub(crate) fn key(self) -> String {
        match self {
            Self::Tension => format!("tensile_strength = {TENSION_PA:e}"),
            Self::Compression => format!("compressive_strength = {COMPRESSION_PA:e}"),
            Self::Shear => format!("shear_strength = {SHEAR_PA:e}"),
            Self::MohrCoulomb => {
                format!("cohesion = {COHESION_PA:e}, friction_angle = \"{FRICTION_DEG} deg\"")
            }
            Self::CutOff => {
                format!(
                    "{}, tensile_strength = {CUT_OFF_PA:e}",
                    Self::MohrCoulomb.key()
                )
            }
            Self::VonMises => format!(
                "von_mises_strength = {VON_MISES_PA:e}, equivalent_stress = \"axial-in-tension\""
            ),
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Tension => "tensile strength",
            Self::Compression => "compressive strength",
            Self::Shear => "shear strength",
            Self::MohrCoulomb => "Mohr-Coulomb",
            Self::CutOff => "Mohr-Coulomb, cut off",
            Self::VonMises => "equivalent stress",
        }
    }

    /// Utilisation of the strength by these stresses.
    pub(crate) fn used(self, s: Stresses) -> f64 {
        let sheared = s.shear + s.torsion;
        match self {
            Self::Tension => (s.bending + s.axial) / TENSION_PA,
            Self::Compression => (s.bending - s.axial) / COMPRESSION_PA,
            Self::Shear => sheared / SHEAR_PA,
            Self::MohrCoulomb => {
                (sheared + s.axial * FRICTION_DEG.to_radians().tan()) / COHESION_PA
            }
            Self::CutOff => {
                let pulled = (s.bending + s.axial) / CUT_OFF_PA;
                pulled.max(Self::MohrCoulomb.used(s))
            }
            Self::VonMises => {
                let pulled = s.axial.max(0.0) + s.bending;
                (pulled * pulled + 3.0 * sheared * sheared).sqrt() / VON_MISES_PA
            }
        }
    }
}

pub(crate) fn area_m2() -> f64 {
    PI * RADIUS_M * RADIUS_M
}

pub(crate) fn second_moment_m4() -> f64 {
    0.25 * PI * RADIUS_M.powi(4)
}

pub(crate) fn shear_modulus_pa() -> f64 {
    YOUNG_PA / (2.0 * (1.0 + POISSON))
}

/// Shear stiffness of a Timoshenko bond, N/m.
pub(crate) fn shear_stiffness_n_m() -> f64 {
    let phi = 20.0 * RADIUS_M * RADIUS_M * (1.0 + POISSON) / (3.0 * LENGTH_M * LENGTH_M);
    12.0 * YOUNG_PA * second_moment_m4() / (LENGTH_M.powi(3) * (1.0 + phi))
}

/// Two spheres and their Timoshenko bond along x; `failure` are its failure keys, `more` is added
/// for the spheres "left" and "right".
pub(crate) fn bond(failure: &str, run: &str, more: &str) -> State {
    bond_of("timoshenko", failure, run, more)
}

/// The same of another model.
pub(crate) fn bond_of(model: &str, failure: &str, run: &str, more: &str) -> State {
    started(&format!(
        r#"
        version = 1
        run = {{ {run} }}
        materials.stone = {{ density = 2500 }}
        bodies.rod = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{LENGTH_M:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue" }}
        groups.left = {{ particles = [0] }}
        groups.right = {{ particles = [1] }}
        bonds.glue = {{ model = "{model}", young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, failure = {{ {failure} }}, damping = {{ damping_ratio = {DAMPING} }} }}
        {more}
        "#
    ))
}

/// Runs until the first bond breaks. Returns the time of the forces that broke it, s.
pub(crate) fn breaks_s(state: &mut State, end_s: f64) -> f64 {
    while state.time_s <= end_s {
        let now_s = state.time_s;
        step(state);
        if state.broken_count > 0 {
            return now_s;
        }
    }
    f64::NAN
}
