//! MUSEN's shear strength.

use crate::bond::stresses::{Criteria, FailureCriterion, Stresses};
use crate::number::Number;

/// Shear force and torsion together: F_s/A + M_tor r/J.
pub(super) struct Shear;

impl FailureCriterion for Shear {
    const NAME: &'static str = "shear";
    const PHRASE: &'static str = "in shear";
    const RISES_WITH_RATE: bool = true;

    fn strength_pa(criteria: &Criteria) -> f64 {
        criteria.shear_strength_pa
    }

    #[inline(always)]
    fn squared<T: Number>(_: &Criteria, stresses: &Stresses<T>) -> T {
        let shear = stresses.shear_pa + stresses.torsion_pa;
        shear * shear
    }
}
