//! Several numbers at once: what the processor has for that, and how rows of memory become lanes.

use crate::physics::number::Number;

#[cfg(all(test, target_arch = "x86_64"))]
mod tests;

/// A number of each of `COUNT` bonds.
pub(super) trait Lanes: Number {
    /// Proof that the processor can do it.
    type Proof: Copy;
    /// How many at once: 1 or all of [`FOUR`].
    const COUNT: usize;

    /// `COUNT` numbers from a column of a block, from place `first` on.
    fn load(proof: Self::Proof, column: &[f64; FOUR], first: usize) -> Self;

    /// All lanes the same.
    fn all(proof: Self::Proof, value: f64) -> Self;

    /// The lanes; those there are not are 0.
    fn values(self) -> [f64; FOUR];

    /// Four numbers of each of `COUNT` bonds: lane by lane what stands row by row.
    fn columns(proof: Self::Proof, rows: impl Fn(usize) -> [f64; 4]) -> [Self; 4];

    /// For each lane a bit, from the lowest on: whether it is above that of the other.
    fn above(self, other: Self) -> u8;

    /// The opposite of [`Lanes::columns`]: row by row what stands lane by lane. Only the first `COUNT` rows have a meaning.
    fn rows(columns: [Self; 4]) -> [[f64; 4]; FOUR];
}

/// Bonds in a block.
pub(super) const FOUR: usize = crate::state::bonds::BLOCK;

impl Lanes for f64 {
    type Proof = ();
    const COUNT: usize = 1;

    #[inline(always)]
    fn load((): (), column: &[f64; FOUR], first: usize) -> Self {
        column[first]
    }

    #[inline(always)]
    fn all((): (), value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn values(self) -> [f64; FOUR] {
        [self, 0.0, 0.0, 0.0]
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
    fn rows(columns: [Self; 4]) -> [[f64; 4]; FOUR] {
        [columns, [0.0; 4], [0.0; 4], [0.0; 4]]
    }
}

/// Work that is done with one lane or with several.
pub(super) trait LaneWork {
    /// Does it.
    fn with<T: Lanes>(self, proof: T::Proof);
}

/// Does the work with as many lanes as the processor has. The bits of the results do not depend on how many.
pub(super) fn with_lanes(work: impl LaneWork) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        struct Vectorized<W>(W, pulp::x86::V3);
        impl<W: LaneWork> pulp::NullaryFnOnce for Vectorized<W> {
            type Output = ();

            #[inline(always)]
            fn call(self) {
                self.0.with::<avx2::Lanes4>(self.1);
            }
        }
        return simd.vectorize(Vectorized(work, simd));
    }
    work.with::<f64>(());
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::__m256d;
    use std::ops::{Add, Div, Mul, Neg, Sub};

    use pulp::cast;
    use pulp::x86::V3;

    use super::{FOUR, Lanes};
    use crate::physics::number::Number;

    /// Four numbers in a register of AVX2.
    #[derive(Clone, Copy)]
    pub(super) struct Lanes4 {
        simd: V3,
        v: __m256d,
    }

    impl Lanes4 {
        #[inline(always)]
        fn with(self, v: __m256d) -> Self {
            Self { simd: self.simd, v }
        }

        #[inline(always)]
        fn constant(self, value: f64) -> __m256d {
            self.simd.avx._mm256_set1_pd(value)
        }
    }

    impl Add for Lanes4 {
        type Output = Self;

        #[inline(always)]
        fn add(self, other: Self) -> Self {
            self.with(self.simd.avx._mm256_add_pd(self.v, other.v))
        }
    }

    impl Sub for Lanes4 {
        type Output = Self;

        #[inline(always)]
        fn sub(self, other: Self) -> Self {
            self.with(self.simd.avx._mm256_sub_pd(self.v, other.v))
        }
    }

    impl Mul for Lanes4 {
        type Output = Self;

        #[inline(always)]
        fn mul(self, other: Self) -> Self {
            self.with(self.simd.avx._mm256_mul_pd(self.v, other.v))
        }
    }

    impl Div for Lanes4 {
        type Output = Self;

        #[inline(always)]
        fn div(self, other: Self) -> Self {
            self.with(self.simd.avx._mm256_div_pd(self.v, other.v))
        }
    }

    impl Neg for Lanes4 {
        type Output = Self;

        #[inline(always)]
        fn neg(self) -> Self {
            let sign = self.constant(-0.0);
            self.with(self.simd.avx._mm256_xor_pd(self.v, sign))
        }
    }

    impl Number for Lanes4 {
        #[inline(always)]
        fn zero(self) -> Self {
            self.with(self.constant(0.0))
        }

        #[inline(always)]
        fn times(self, factor: f64) -> Self {
            self.with(self.simd.avx._mm256_mul_pd(self.v, self.constant(factor)))
        }

        #[inline(always)]
        fn plus(self, term: f64) -> Self {
            self.with(self.simd.avx._mm256_add_pd(self.v, self.constant(term)))
        }

        #[inline(always)]
        fn inverse(self) -> Self {
            self.with(self.simd.avx._mm256_div_pd(self.constant(1.0), self.v))
        }

        #[inline(always)]
        fn root(self) -> Self {
            self.with(self.simd.avx._mm256_sqrt_pd(self.v))
        }

        #[inline(always)]
        fn larger(self, other: Self) -> Self {
            self.with(self.simd.avx._mm256_max_pd(self.v, other.v))
        }

        #[inline(always)]
        fn smaller(self, other: Self) -> Self {
            self.with(self.simd.avx._mm256_min_pd(self.v, other.v))
        }

        #[inline(always)]
        fn sign(self) -> Self {
            let sign = self.simd.avx._mm256_and_pd(self.v, self.constant(-0.0));
            self.with(self.simd.avx._mm256_or_pd(sign, self.constant(1.0)))
        }

        #[inline(always)]
        fn if_positive(self, value: Self) -> Self {
            let zero = self.constant(0.0);
            let positive = self
                .simd
                .avx
                ._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_GT_OQ }>(self.v, zero);
            self.with(self.simd.avx._mm256_and_pd(positive, value.v))
        }
    }

    /// Rows and columns of four by four numbers exchanged.
    #[inline(always)]
    fn transposed(simd: V3, [r0, r1, r2, r3]: [__m256d; 4]) -> [__m256d; 4] {
        let avx = simd.avx;
        let (low01, high01) = (
            avx._mm256_unpacklo_pd(r0, r1),
            avx._mm256_unpackhi_pd(r0, r1),
        );
        let (low23, high23) = (
            avx._mm256_unpacklo_pd(r2, r3),
            avx._mm256_unpackhi_pd(r2, r3),
        );
        [
            avx._mm256_permute2f128_pd::<0x20>(low01, low23),
            avx._mm256_permute2f128_pd::<0x20>(high01, high23),
            avx._mm256_permute2f128_pd::<0x31>(low01, low23),
            avx._mm256_permute2f128_pd::<0x31>(high01, high23),
        ]
    }

    impl Lanes for Lanes4 {
        type Proof = V3;
        const COUNT: usize = FOUR;

        #[inline(always)]
        fn load(simd: V3, column: &[f64; FOUR], _: usize) -> Self {
            Self {
                simd,
                v: cast(*column),
            }
        }

        #[inline(always)]
        fn all(simd: V3, value: f64) -> Self {
            let v = simd.avx._mm256_set1_pd(value);
            Self { simd, v }
        }

        #[inline(always)]
        fn values(self) -> [f64; FOUR] {
            cast(self.v)
        }

        #[inline(always)]
        fn columns(simd: V3, rows: impl Fn(usize) -> [f64; 4]) -> [Self; 4] {
            let rows = [cast(rows(0)), cast(rows(1)), cast(rows(2)), cast(rows(3))];
            let [x, y, z, w] = transposed(simd, rows);
            [
                Self { simd, v: x },
                Self { simd, v: y },
                Self { simd, v: z },
                Self { simd, v: w },
            ]
        }

        #[inline(always)]
        fn above(self, other: Self) -> u8 {
            let avx = self.simd.avx;
            let above = avx._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_GT_OQ }>(self.v, other.v);
            avx._mm256_movemask_pd(above) as u8
        }

        #[inline(always)]
        fn rows(columns: [Self; 4]) -> [[f64; 4]; FOUR] {
            let simd = columns[0].simd;
            let [x, y, z, w] = columns;
            let [r0, r1, r2, r3] = transposed(simd, [x.v, y.v, z.v, w.v]);
            [cast(r0), cast(r1), cast(r2), cast(r3)]
        }
    }
}
