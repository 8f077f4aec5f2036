//! Four numbers at once, for processors with AVX2.

use std::arch::x86_64::__m256d;

use pulp::cast;
use pulp::x86::V3;

use super::common::{FOUR, Lanes, MOST};
use super::register::lanes_in_register;

lanes_in_register! {
    /// Four numbers in an AVX2 register.
    Lanes4: __m256d of V3,
    numbers: avx { sqrt: _mm256_sqrt_pd, max: _mm256_max_pd, min: _mm256_min_pd, },
    operators: {
        Add::add: _mm256_add_pd,
        Sub::sub: _mm256_sub_pd,
        Mul::mul: _mm256_mul_pd,
        Div::div: _mm256_div_pd,
    },
    bits: avx { xor: _mm256_xor_pd, and: _mm256_and_pd, or: _mm256_or_pd, },
}

impl Lanes4 {
    #[inline(always)]
    fn where_positive(self, value: Self) -> Self {
        let zero = self.constant(0.0).v;
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
