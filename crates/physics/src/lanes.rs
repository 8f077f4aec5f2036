//! SIMD lanes: several numbers at once, as the processor supports, and how rows of memory become
//! lanes.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod common;
#[cfg(target_arch = "x86_64")]
mod register;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;

pub use common::{Lanes, MOST};

/// Work that is done with one lane or with several.
pub trait LaneWork {
    /// Does the work.
    fn with<T: Lanes>(self, proof: T::Proof);
}

/// The number of the lowest of some lanes, one for each bit, which is cleared.
#[inline(always)]
pub fn next_of(bits: &mut u32) -> usize {
    let lowest = bits.trailing_zeros() as usize;
    *bits &= *bits - 1;
    lowest
}

/// The vector instructions of this processor that the program uses.
pub fn instructions() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if pulp::x86::V4::try_new().is_some() {
            return "AVX-512";
        }
        if pulp::x86::V3::try_new().is_some() {
            return "AVX2";
        }
    }
    "neither AVX-512 nor AVX2"
}

/// Whether this processor has all of AVX2 if it has FMA, and all of AVX-512 if it has AVX-512F: a
/// library that asks for the part alone fails on others, such as AMD Piledriver.
pub fn has_whole_sets() -> bool {
    #[cfg(target_arch = "x86_64")]
    {
        let has_parts = [
            std::arch::is_x86_feature_detected!("fma"),
            std::arch::is_x86_feature_detected!("avx512f"),
        ];
        let has_all = [
            pulp::x86::V3::try_new().is_some(),
            pulp::x86::V4::try_new().is_some(),
        ];
        std::iter::zip(has_parts, has_all).all(|(part, all)| all || !part)
    }
    #[cfg(not(target_arch = "x86_64"))]
    true
}

/// Does the work with up to four lanes. The results are the same, bit for bit, for any number.
pub fn with_lanes(work: impl LaneWork) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(Vectorized::<_, avx2::Lanes4>(work, simd));
    }
    work.with::<f64>(());
}

/// Does the work with up to eight lanes. The results are the same, bit for bit, for any number.
pub fn with_most_lanes(work: impl LaneWork) {
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
