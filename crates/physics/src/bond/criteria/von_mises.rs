//! Equivalent stress of von Mises (Platzer 2022, eqs. 11-13).

use crate::bond::stresses::{Criteria, EquivalentStress, FailureCriterion, Stresses};
use crate::number::Number;

/// Equivalent stress sqrt(sigma^2 + 3 tau^2), whose normal part sigma counts only in tension.
/// [`EquivalentStress`] defines both stresses.
pub(super) struct VonMises;

impl FailureCriterion for VonMises {
    const NAME: &'static str = "von_mises";
    const PHRASE: &'static str = "by equivalent stress";
    const RISES_WITH_RATE: bool = true;

    fn strength_pa(criteria: &Criteria) -> f64 {
        criteria.von_mises_strength_pa
    }

    #[inline(always)]
    fn squared<T: Number>(criteria: &Criteria, stresses: &Stresses<T>) -> T {
        let axial = stresses.axial_pa;
        let edge = stresses.tensile_edge_pa();
        let pulled = axial.if_positive(axial);
        let sheared = stresses.shear_pa + stresses.torsion_pa;
        let (normal, shear) = match criteria.equivalent_stress {
            EquivalentStress::ForcesOnly => (pulled, stresses.shear_pa),
            EquivalentStress::AxialInTension => (pulled + stresses.bending_pa, sheared),
            EquivalentStress::TensileEdge => (edge.if_positive(edge), sheared),
            EquivalentStress::BondInTension => (axial.if_positive(edge), sheared),
        };
        normal * normal + shear.scale(3.0) * shear
    }
}
