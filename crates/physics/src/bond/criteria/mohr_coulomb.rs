//! Mohr-Coulomb strength of the section of a bond: cohesion and friction angle.

use crate::bond::stresses::{Criteria, FailureCriterion, Stresses};
use crate::number::Number;

/// Shear stress beyond c - sigma tan(phi), with sigma = F_n/A, tension positive, and tau from shear
/// force and torsion.
///
/// Compared is tau + sigma tan(phi) with the cohesion c. Where pressure outweighs shear it is below
/// 0, and such a bond does not fail however large the pressure. Without shear, the cone ends at a
/// tension of c/tan(phi); the tensile strength, if there is one, cuts it off before. Bending
/// presses one half of the section as much as it pulls the other: its friction cancels, and it
/// counts at the tensile edge only.
pub(super) struct MohrCoulomb;

impl FailureCriterion for MohrCoulomb {
    const NAME: &'static str = "mohr_coulomb";
    const PHRASE: &'static str = "by Mohr-Coulomb";
    const RISES_WITH_RATE: bool = true;

    fn strength_pa(criteria: &Criteria) -> f64 {
        criteria.cohesion_pa
    }

    #[inline(always)]
    fn squared<T: Number>(criteria: &Criteria, stresses: &Stresses<T>) -> T {
        let shear = stresses.shear_pa + stresses.torsion_pa;
        let sliding = shear + stresses.axial_pa.scale(criteria.friction_tangent);
        let sliding = sliding.if_positive(sliding);
        sliding * sliding
    }
}
