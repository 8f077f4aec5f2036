//! Failure criteria, one per file, and the one place that lists them. See `doc/adding-a-model.md`
//! for how to add another.

mod compression;
mod mohr_coulomb;
mod shear;
mod tension;
mod von_mises;

use serde::{Deserialize, Serialize};

use super::stresses::{Criteria, FailureCriterion, Stresses};
use crate::number::Number;

use self::compression::Compression;
use self::mohr_coulomb::MohrCoulomb;
use self::shear::Shear;
use self::tension::Tension;
use self::von_mises::VonMises;

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
