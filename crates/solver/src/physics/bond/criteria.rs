//! Failure criteria, one per file, and the one place that lists them. See `doc/adding-a-model.md`
//! for how to add another.

mod compression;
mod shear;
mod tension;
mod von_mises;

use super::stresses::{Cause, Criteria, FailureCriterion, Stresses};
use crate::physics::number::Number;

use self::compression::Compression;
use self::shear::Shear;
use self::tension::Tension;
use self::von_mises::VonMises;

/// Number of criteria.
pub const COUNT: usize = 4;

/// The squares of all criteria, in the order of [`Cause::ALL`].
#[inline(always)]
pub(super) fn squared<T: Number>(stresses: &Stresses<T>) -> [T; COUNT] {
    [
        Tension::squared(stresses),
        Compression::squared(stresses),
        Shear::squared(stresses),
        VonMises::squared(stresses),
    ]
}

/// The strengths of all criteria, Pa, and whether they increase with the strain rate.
#[inline(always)]
pub(super) fn strengths(criteria: &Criteria) -> [(f64, bool); COUNT] {
    fn of<C: FailureCriterion>(criteria: &Criteria) -> (f64, bool) {
        (C::strength_pa(criteria), C::RISES_WITH_RATE)
    }
    [
        of::<Tension>(criteria),
        of::<Compression>(criteria),
        of::<Shear>(criteria),
        of::<VonMises>(criteria),
    ]
}

impl Cause {
    /// All, in the order of the criteria.
    pub const ALL: [Self; COUNT] = [
        Tension::CAUSE,
        Compression::CAUSE,
        Shear::CAUSE,
        VonMises::CAUSE,
    ];
}
