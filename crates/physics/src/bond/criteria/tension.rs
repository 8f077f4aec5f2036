//! Strength at the tensile edge (MUSEN's normal strength, with the sign of the axial force).

use crate::bond::stresses::{Criteria, FailureCriterion, Stresses};
use crate::number::Number;

/// Axial and bending stress at the edge with the largest tension: F_n/A + M_ben r/I.
pub(super) struct Tension;

impl FailureCriterion for Tension {
    const NAME: &'static str = "tension";
    const PHRASE: &'static str = "in tension";
    const RISES_WITH_RATE: bool = true;

    fn strength_pa(criteria: &Criteria) -> f64 {
        criteria.tensile_strength_pa
    }

    #[inline(always)]
    fn squared<T: Number>(_: &Criteria, stresses: &Stresses<T>) -> T {
        let edge = stresses.tensile_edge_pa();
        let pulled = edge.if_positive(edge);
        pulled * pulled
    }
}
