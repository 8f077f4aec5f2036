//! Strength at the compressed edge.

use crate::bond::stresses::{Criteria, FailureCriterion, Stresses};
use crate::number::Number;

/// Axial and bending stress at the edge with the largest compression: -F_n/A + M_ben r/I. The
/// strength does not rise with the strain rate.
pub(super) struct Compression;

impl FailureCriterion for Compression {
    const NAME: &'static str = "compression";
    const PHRASE: &'static str = "in compression";
    const RISES_WITH_RATE: bool = false;

    fn strength_pa(criteria: &Criteria) -> f64 {
        criteria.compressive_strength_pa
    }

    #[inline(always)]
    fn squared<T: Number>(_: &Criteria, stresses: &Stresses<T>) -> T {
        let edge = stresses.pressed_edge_pa();
        let pressed = edge.if_positive(edge);
        pressed * pressed
    }
}
