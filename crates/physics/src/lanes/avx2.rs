//! Four numbers at once, for processors with AVX2.

use std::arch::x86_64::__m256d;
use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::cast;
use pulp::x86::V3;

use super::common::{FOUR, Lanes, MOST};
use crate::number::Number;

/// Four numbers in an AVX2 register.
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
    fn scale(self, factor: f64) -> Self {
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
    fn sqrt(self) -> Self {
        self.with(self.simd.avx._mm256_sqrt_pd(self.v))
    }

    #[inline(always)]
    fn maximum(self, other: Self) -> Self {
        self.with(self.simd.avx._mm256_max_pd(self.v, other.v))
    }

    #[inline(always)]
    fn minimum(self, other: Self) -> Self {
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

/// Transposes four by four numbers.
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
    fn load(simd: V3, column: &[f64], first: usize) -> Self {
        let four = &column[first..first + FOUR];
        Self {
            simd,
            v: cast([four[0], four[1], four[2], four[3]]),
        }
    }

    #[inline(always)]
    fn all(simd: V3, value: f64) -> Self {
        let v = simd.avx._mm256_set1_pd(value);
        Self { simd, v }
    }

    #[inline(always)]
    fn values(self) -> [f64; MOST] {
        let [a, b, c, d]: [f64; FOUR] = cast(self.v);
        [a, b, c, d, 0.0, 0.0, 0.0, 0.0]
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
    fn rows(columns: [Self; 4]) -> [[f64; 4]; MOST] {
        let simd = columns[0].simd;
        let [x, y, z, w] = columns;
        let [r0, r1, r2, r3] = transposed(simd, [x.v, y.v, z.v, w.v]);
        let none = [0.0; 4];
        [
            cast(r0),
            cast(r1),
            cast(r2),
            cast(r3),
            none,
            none,
            none,
            none,
        ]
    }
}
