//! Failure criteria, and their list. See `doc/inside/adding-a-model.md` for how to add another.

use serde::{Deserialize, Serialize};

use super::stresses::{Criteria, EquivalentStress, FailureCriterion, Stresses};
use crate::number::Number;

/// Makes the list of criteria and the causes of failure that bear their names.
macro_rules! criteria {
    ($($(#[$doc:meta])+ $criterion:ident,)+) => {
        /// The criterion by which a bond failed.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Cause {
            $($(#[$doc])+ $criterion,)+
        }

        /// Number of criteria.
        pub const COUNT: usize = [$($criterion::NAME),+].len();

        impl Cause {
            /// All, in the order of the criteria.
            pub const ALL: [Self; COUNT] = [$(Self::$criterion),+];

            /// Its name in results: `von_mises`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$criterion => $criterion::NAME,)+
                }
            }

            /// How bonds fail by it, in words: "by equivalent stress".
            pub fn phrase(self) -> &'static str {
                match self {
                    $(Self::$criterion => $criterion::PHRASE,)+
                }
            }
        }

        /// The squares of all criteria, in the order of [`Cause::ALL`].
        #[inline(always)]
        pub(super) fn squared<T: Number>(criteria: &Criteria, stresses: &Stresses<T>) -> [T; COUNT] {
            [$($criterion::squared(criteria, stresses)),+]
        }

        /// The strengths of all criteria, Pa, and whether the strain rate raises them, in the order
        /// of [`Cause::ALL`].
        #[inline(always)]
        pub(super) fn strengths(criteria: &Criteria) -> [(f64, bool); COUNT] {
            [$(($criterion::strength_pa(criteria), $criterion::RISES_WITH_RATE)),+]
        }
    };
}

criteria! {
    /// Strength at the tensile edge.
    Tension,
    /// Strength at the pressed edge.
    Compression,
    /// Shear strength.
    Shear,
    /// Equivalent stress.
    VonMises,
    /// Cohesion and friction angle. The last, so that the loop over bonds can leave it out.
    MohrCoulomb,
}

/// Axial and bending stress at the edge with the largest tension: F_n/A + M_ben r/I (MUSEN's normal
/// strength, with the sign of the axial force).
struct Tension;

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

/// Axial and bending stress at the edge with the largest compression: -F_n/A + M_ben r/I. The
/// strength does not rise with the strain rate.
struct Compression;

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

/// Shear force and torsion together: F_s/A + M_tor r/J (MUSEN's shear strength).
struct Shear;

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

/// Equivalent stress sqrt(sigma^2 + 3 tau^2) of von Mises (Platzer 2022, eqs. 11-13), whose normal
/// part sigma counts only in tension. [`EquivalentStress`] defines both stresses.
struct VonMises;

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

/// Shear stress beyond c - sigma tan(phi), with sigma = F_n/A, tension positive, and tau from shear
/// force and torsion.
///
/// Compared is tau + sigma tan(phi) with the cohesion c. Where pressure outweighs shear it is below
/// 0, and such a bond does not fail however large the pressure. Without shear, the cone ends at a
/// tension of c/tan(phi); the tensile strength, if there is one, cuts it off before. Bending
/// presses one half of the section as much as it pulls the other: its friction cancels, and it
/// counts at the tensile edge only.
struct MohrCoulomb;

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
