//! Eight numbers at once, for processors with AVX-512.

use std::arch::x86_64::{__m512d, __m512i};

use pulp::cast;
use pulp::x86::V4;

use super::common::{Lanes, MOST};
use super::register::lanes_in_register;

lanes_in_register! {
    /// Eight numbers in an AVX-512 register.
    Lanes8: __m512d of V4,
    numbers: avx512f { sqrt: _mm512_sqrt_pd, max: _mm512_max_pd, min: _mm512_min_pd, },
    operators: {
        Add::add: _mm512_add_pd,
        Sub::sub: _mm512_sub_pd,
        Mul::mul: _mm512_mul_pd,
        Div::div: _mm512_div_pd,
    },
    bits: avx512dq { xor: _mm512_xor_pd, and: _mm512_and_pd, or: _mm512_or_pd, },
}

impl Lanes8 {
    #[inline(always)]
    fn where_positive(self, value: Self) -> Self {
        let avx = self.simd.avx512f;
        let zero = self.constant(0.0).v;
        let positive = avx._mm512_cmp_pd_mask::<{ std::arch::x86_64::_CMP_GT_OQ }>(self.v, zero);
        self.with(avx._mm512_maskz_mov_pd(positive, value.v))
    }
}

impl Lanes for Lanes8 {
    type Proof = V4;
    const COUNT: usize = MOST;

    #[inline(always)]
    fn load(simd: V4, column: &[f64], first: usize) -> Self {
        let mut eight = [0.0; MOST];
        eight.copy_from_slice(&column[first..first + MOST]);
        Self {
            simd,
            v: cast(eight),
        }
    }

    #[inline(always)]
    fn all(simd: V4, value: f64) -> Self {
        let v = simd.avx512f._mm512_set1_pd(value);
        Self { simd, v }
    }

    #[inline(always)]
    fn values(self) -> [f64; MOST] {
        cast(self.v)
    }

    #[inline(always)]
    fn columns(simd: V4, rows: impl Fn(usize) -> [f64; 4]) -> [Self; 4] {
        let avx = simd.avx512f;
        // Two rows share a register, so that its halves need not be exchanged.
        let r02: __m512d = cast([rows(0), rows(2)]);
        let r13: __m512d = cast([rows(1), rows(3)]);
        let r46: __m512d = cast([rows(4), rows(6)]);
        let r57: __m512d = cast([rows(5), rows(7)]);
        let (xz03, yw03) = (
            avx._mm512_unpacklo_pd(r02, r13),
            avx._mm512_unpackhi_pd(r02, r13),
        );
        let (xz47, yw47) = (
            avx._mm512_unpacklo_pd(r46, r57),
            avx._mm512_unpackhi_pd(r46, r57),
        );
        let first = |a, b| Self {
            simd,
            v: avx._mm512_shuffle_f64x2::<0b10_00_10_00>(a, b),
        };
        let second = |a, b| Self {
            simd,
            v: avx._mm512_shuffle_f64x2::<0b11_01_11_01>(a, b),
        };
        [
            first(xz03, xz47),
            first(yw03, yw47),
            second(xz03, xz47),
            second(yw03, yw47),
        ]
    }

    #[inline(always)]
    fn above(self, other: Self) -> u8 {
        let avx = self.simd.avx512f;
        avx._mm512_cmp_pd_mask::<{ std::arch::x86_64::_CMP_GT_OQ }>(self.v, other.v)
    }

    #[inline(always)]
    fn rows([x, y, z, w]: [Self; 4]) -> [[f64; 4]; MOST] {
        let avx = x.simd.avx512f;
        let (xy_even, xy_odd) = (
            avx._mm512_unpacklo_pd(x.v, y.v),
            avx._mm512_unpackhi_pd(x.v, y.v),
        );
        let (zw_even, zw_odd) = (
            avx._mm512_unpacklo_pd(z.v, w.v),
            avx._mm512_unpackhi_pd(z.v, w.v),
        );
        let low: __m512i = cast([0_i64, 1, 8, 9, 2, 3, 10, 11]);
        let high: __m512i = cast([4_i64, 5, 12, 13, 6, 7, 14, 15]);
        let [r0, r2]: [[f64; 4]; 2] = cast(avx._mm512_permutex2var_pd(xy_even, low, zw_even));
        let [r1, r3]: [[f64; 4]; 2] = cast(avx._mm512_permutex2var_pd(xy_odd, low, zw_odd));
        let [r4, r6]: [[f64; 4]; 2] = cast(avx._mm512_permutex2var_pd(xy_even, high, zw_even));
        let [r5, r7]: [[f64; 4]; 2] = cast(avx._mm512_permutex2var_pd(xy_odd, high, zw_odd));
        [r0, r1, r2, r3, r4, r5, r6, r7]
    }
}
