//! Stresses in the section of a bond, its strengths, and failure criteria.
//!
//! A round bond: A = pi r^2, I = A r^2 / 4, J = 2 I.

use std::f64::consts::PI;

use serde::Serialize;

use super::BondLoad;
use crate::number::Number;

/// Strengths of a bond, none below 0. An infinite strength is not checked. With a strength of 0,
/// any load breaks the bond, and no load does not. Several may act together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Criteria {
    /// Largest stress at the tensile edge: F_n / A + M_ben r / I, tension positive, Pa.
    pub tensile_strength_pa: f64,
    /// Largest stress at the compressed edge: -F_n / A + M_ben r / I, Pa.
    pub compressive_strength_pa: f64,
    /// MUSEN's shear strength: largest shear stress from shear force and torsion, Pa.
    pub shear_strength_pa: f64,
    /// Cohesion of Mohr and Coulomb: largest tau + sigma tan(phi), with sigma = F_n / A, tension
    /// positive, and tau from shear force and torsion, Pa.
    pub cohesion_pa: f64,
    /// tan(phi) there: 0 or more.
    pub friction_tangent: f64,
    /// Equivalent stress of Platzer 2022, eq. 13, whose normal part counts only in tension, Pa.
    pub von_mises_strength_pa: f64,
    /// The stresses of which that equivalent stress consists.
    pub equivalent_stress: EquivalentStress,
}

impl Criteria {
    /// Whether the cohesion is a strength that a stress can reach.
    pub fn is_frictional(&self) -> bool {
        self.cohesion_pa.is_finite()
    }

    /// Whether bending alone can break a bond.
    pub fn count_bending(&self) -> bool {
        let at_edges = [
            self.tensile_strength_pa,
            self.compressive_strength_pa,
            self.cohesion_pa,
        ];
        let by_forces_only = self.equivalent_stress == EquivalentStress::ForcesOnly;
        at_edges.iter().any(|strength_pa| strength_pa.is_finite())
            || (self.von_mises_strength_pa.is_finite() && !by_forces_only)
    }
}

/// Readings of Platzer 2022, eq. 13, and of "the normal stress component is only considered under
/// tension" (section 2.2 there).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub enum EquivalentStress {
    /// The axial stress if it is tensile, and that of the shear force, but neither bending nor
    /// torsion: the stresses of eq. 11 without those of eq. 12, as eq. 13 names them. A bond that
    /// is only bent or twisted does not break.
    #[default]
    ForcesOnly,
    /// The axial stress if it is tensile, and the bending stress always; shear and torsion.
    AxialInTension,
    /// The stress at the edge with the largest tension, axial and bending, if it is tensile; shear
    /// and torsion.
    TensileEdge,
    /// Axial and bending stress while the axial force is tensile; shear and torsion.
    BondInTension,
}

/// Largest stresses in the section of a bond, each from one mode.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stresses<T = f64> {
    /// F_n / A, tension positive, Pa.
    pub axial_pa: T,
    /// M_ben r / I, Pa. Not negative.
    pub bending_pa: T,
    /// F_s / A, Pa. Not negative.
    pub shear_pa: T,
    /// M_tor r / J, Pa. Not negative.
    pub torsion_pa: T,
}

impl<T: Number> Stresses<T> {
    /// Stress at the edge with the largest tension; below 0 if the entire section is in
    /// compression, Pa.
    #[inline(always)]
    pub fn tensile_edge_pa(&self) -> T {
        self.bending_pa + self.axial_pa
    }

    /// Stress at the edge with the largest compression; below 0 if the entire section is in
    /// tension, Pa.
    #[inline(always)]
    pub fn pressed_edge_pa(&self) -> T {
        self.bending_pa - self.axial_pa
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

/// A criterion: a stress that is compared with a strength.
pub trait FailureCriterion {
    /// Its name in results: `von_mises`.
    const NAME: &'static str;
    /// How bonds fail by it, in words: "by equivalent stress".
    const PHRASE: &'static str;
    /// Whether its strength rises with the strain rate.
    const RISES_WITH_RATE: bool;

    /// Its strength, Pa; infinite: not checked.
    fn strength_pa(criteria: &Criteria) -> f64;

    /// Square of the stress that it compares, Pa2: squares avoid a root while many bonds are
    /// checked. Stresses and square may be multiplied by a number above 0 and its square.
    fn squared<T: Number>(criteria: &Criteria, stresses: &Stresses<T>) -> T;
}
