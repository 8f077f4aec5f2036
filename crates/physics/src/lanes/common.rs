//! What all lanes have in common; and one lane, for any processor.

use crate::number::Number;

/// One number for each of `COUNT` bonds or contacts.
pub trait Lanes: Number {
    /// Proof that the processor supports it.
    type Proof: Copy;
    /// Number of lanes: 1, 4 or [`MOST`].
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

/// Number of lanes of a processor with AVX2.
pub(super) const FOUR: usize = 4;

/// Largest number of lanes of any processor.
pub const MOST: usize = 8;

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
