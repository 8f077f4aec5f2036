//! Equivalent stress of von Mises (Platzer 2022, eqs. 11-13).

use crate::physics::bond::stresses::{Criteria, FailureCriterion, Stresses};
use crate::physics::number::Number;

/// Equivalent stress, whose axial part counts only in tension.
pub(super) struct VonMises;

impl FailureCriterion for VonMises {
    const NAME: &'static str = "von_mises";
    const PHRASE: &'static str = "by equivalent stress";
    const RISES_WITH_RATE: bool = true;

    fn strength_pa(criteria: &Criteria) -> f64 {
        criteria.von_mises_strength_pa
    }

    #[inline(always)]
    fn squared<T: Number>(stresses: &Stresses<T>) -> T {
        let pulled = stresses.axial_pa.if_positive(stresses.axial_pa) + stresses.bending_pa;
        let shear = stresses.shear_pa + stresses.torsion_pa;
        pulled * pulled + shear.scale(3.0) * shear
    }
}
