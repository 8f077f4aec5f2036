//! SIMD lanes: several numbers at once, as the processor supports, and how rows of memory become
//! lanes.

use crate::physics::number::Number;

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;

/// One number for each of `COUNT` bonds or contacts.
pub(super) trait Lanes: Number {
    /// Proof that the processor supports it.
    type Proof: Copy;
    /// Number of lanes: 1, [`FOUR`] or [`MOST`].
    const COUNT: usize;

    /// `COUNT` numbers from a column, from place `first` on.
    fn load(proof: Self::Proof, column: &[f64], first: usize) -> Self;

    /// All lanes the same.
    fn all(proof: Self::Proof, value: f64) -> Self;

    /// The lanes, padded with 0.
    fn values(self) -> [f64; MOST];

    /// Four numbers for each of `COUNT` bonds or contacts: transposes rows into lanes.
    fn columns(proof: Self::Proof, rows: impl Fn(usize) -> [f64; 4]) -> [Self; 4];

    /// A bit for each lane, lowest first: whether it is greater than that of `other`.
    fn above(self, other: Self) -> u8;

    /// The opposite of [`Lanes::columns`]: transposes lanes into rows. Only the first `COUNT` rows
    /// are valid.
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST];
}

/// Bonds in a block.
pub(super) const FOUR: usize = crate::state::bonds::BLOCK;
/// Largest number of lanes of any processor.
pub(super) const MOST: usize = 8;

impl Lanes for f64 {
    type Proof = ();
    const COUNT: usize = 1;

    #[inline(always)]
    fn load((): (), column: &[f64], first: usize) -> Self {
        column[first]
    }

    #[inline(always)]
    fn all((): (), value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn values(self) -> [f64; MOST] {
        [self, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    #[inline(always)]
    fn columns((): (), rows: impl Fn(usize) -> [f64; 4]) -> [Self; 4] {
        rows(0)
    }

    #[inline(always)]
    fn above(self, other: Self) -> u8 {
        u8::from(self > other)
    }

    #[inline(always)]
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST] {
        let none = [0.0; 4];
        [columns, none, none, none, none, none, none, none]
    }
}

/// Work that is done with one lane or with several.
pub(super) trait LaneWork {
    /// Does the work.
    fn with<T: Lanes>(self, proof: T::Proof);
}

/// Does the work with up to four lanes. The results are the same, bit for bit, for any number.
pub(super) fn with_lanes(work: impl LaneWork) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(Vectorized::<_, avx2::Lanes4>(work, simd));
    }
    work.with::<f64>(());
}

/// Does the work with up to eight lanes. The results are the same, bit for bit, for any number.
pub(super) fn with_most_lanes(work: impl LaneWork) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V4::try_new() {
        return simd.vectorize(Vectorized::<_, avx512::Lanes8>(work, simd));
    }
    with_lanes(work);
}

/// Work compiled for a processor with these lanes.
#[cfg(target_arch = "x86_64")]
struct Vectorized<W, T: Lanes>(W, T::Proof);

#[cfg(target_arch = "x86_64")]
impl<W: LaneWork, T: Lanes> pulp::NullaryFnOnce for Vectorized<W, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        self.0.with::<T>(self.1);
    }
}
