//! The two loops in which settling spends most of its time, for eight spheres at once with AVX-512.
//! Results are those of the loops for [`LANES`], bit for bit.

use std::arch::x86_64::{__m256d, __m256i, __m512d, _CMP_GT_OQ, _CMP_LT_OQ};

use pulp::cast;
use pulp::x86::V4;

use super::cells::{AT_ONCE, LANES, Row};
use crate::spheres::ReducedSphere;

/// Work for eight spheres at once. Closures around lanes may not be compiled for them, hence none
/// of more than a call.
pub(super) struct Eight<W>(pub(super) V4, pub(super) W);

/// As [`super::neighbours::add_near`].
#[inline(always)]
pub(super) fn add_near(
    simd: V4,
    (ball, number): (&ReducedSphere, u32),
    row: &Row,
    skin: f64,
    list: &mut [u32],
    end: &mut usize,
) {
    let (avx, vl) = (simd.avx512f, simd.avx512vl);
    let own: __m256i = cast([number; AT_ONCE]);
    let [xs, ys, zs, radii] = &row.coordinates;
    for first in row.spheres.clone().step_by(AT_ONCE) {
        let dx = avx._mm512_sub_pd(all(simd, ball[0]), load(xs, first));
        let dy = avx._mm512_sub_pd(all(simd, ball[1]), load(ys, first));
        let dz = avx._mm512_sub_pd(all(simd, ball[2]), load(zs, first));
        let squared = square_of(simd, dx, dy, dz);
        let reach = avx._mm512_add_pd(all(simd, ball[3]), load(radii, first));
        let reach = avx._mm512_add_pd(reach, all(simd, skin));
        let reach = avx._mm512_mul_pd(reach, reach);
        let near = avx._mm512_cmp_pd_mask::<_CMP_LT_OQ>(squared, reach);
        let mut numbers = [0; AT_ONCE];
        numbers.copy_from_slice(&row.numbers[first..first + AT_ONCE]);
        let numbers: __m256i = cast(numbers);
        let others = vl._mm256_cmpneq_epi32_mask(numbers, own);
        let left = row.spheres.end - first;
        let in_row = u8::MAX >> AT_ONCE.saturating_sub(left);
        let kept = near & others & in_row;
        let kept_numbers: [u32; AT_ONCE] = cast(vl._mm256_maskz_compress_epi32(kept, numbers));
        list[*end..*end + AT_ONCE].copy_from_slice(&kept_numbers);
        *end += kept.count_ones() as usize;
    }
}

#[inline(always)]
fn all(simd: V4, value: f64) -> __m512d {
    simd.avx512f._mm512_set1_pd(value)
}

#[inline(always)]
fn load(column: &[f64], first: usize) -> __m512d {
    let mut lanes = [0.0; AT_ONCE];
    lanes.copy_from_slice(&column[first..first + AT_ONCE]);
    cast(lanes)
}

#[inline(always)]
fn square_of(simd: V4, x: __m512d, y: __m512d, z: __m512d) -> __m512d {
    let avx = simd.avx512f;
    let xy = avx._mm512_add_pd(avx._mm512_mul_pd(x, x), avx._mm512_mul_pd(y, y));
    avx._mm512_add_pd(xy, avx._mm512_mul_pd(z, z))
}

/// The force of the neighbours in a list on a sphere, given with its number. Raises the largest
/// overlaps, in radii of the sphere that overlaps, one of each lane.
#[inline(always)]
pub(super) fn of_neighbours(
    simd: V4,
    (number, ball): (u32, &ReducedSphere),
    list: &[[u32; LANES]],
    balls: &[ReducedSphere],
    worst: &mut __m256d,
) -> [f64; 3] {
    let mut push = ForceLanes {
        force: [cast([0.0_f64; LANES]); 3],
        overlap: cast([0.0_f64; AT_ONCE]),
    };
    let (pairs, last) = list.as_chunks::<2>();
    for groups in pairs {
        push.add(simd, (number, ball), groups, balls);
    }
    for group in last {
        push.add(simd, (number, ball), &[*group, [number; LANES]], balls);
    }
    *worst = push.worst(simd, ball[3], *worst);
    push.sum()
}

/// Forces and largest overlaps of the neighbours of one sphere, in [`LANES`] partial sums of forces
/// that are added at the end.
struct ForceLanes {
    force: [__m256d; 3],
    overlap: __m512d,
}

impl ForceLanes {
    /// Adds two groups of neighbours, one after the other. `number`: of the sphere itself, which
    /// does not count.
    #[inline(always)]
    fn add(
        &mut self,
        simd: V4,
        (number, ball): (u32, &ReducedSphere),
        groups: &[[u32; LANES]; 2],
        balls: &[ReducedSphere],
    ) {
        let (avx, vl) = (simd.avx512f, simd.avx512vl);
        let [x, y, z, radius] = columns(simd, groups, balls);
        let dx = avx._mm512_sub_pd(all(simd, ball[0]), x);
        let dy = avx._mm512_sub_pd(all(simd, ball[1]), y);
        let dz = avx._mm512_sub_pd(all(simd, ball[2]), z);
        let touching = avx._mm512_add_pd(all(simd, ball[3]), radius);
        let squared = square_of(simd, dx, dy, dz);
        let of_touching = avx._mm512_mul_pd(touching, touching);
        let overlaps = avx._mm512_cmp_pd_mask::<_CMP_GT_OQ>(of_touching, squared);
        let others = vl._mm256_cmpneq_epi32_mask(cast(*groups), cast([number; AT_ONCE]));
        let excess = avx._mm512_maskz_sub_pd(overlaps & others, of_touching, squared);
        let push = avx._mm512_div_pd(avx._mm512_mul_pd(all(simd, 0.5), excess), of_touching);
        let overlap = avx._mm512_mul_pd(push, touching);
        self.overlap = avx._mm512_max_pd(overlap, self.overlap);
        let [x, y, z] = self.force;
        self.force = [
            add_halves(simd, x, avx._mm512_mul_pd(push, dx)),
            add_halves(simd, y, avx._mm512_mul_pd(push, dy)),
            add_halves(simd, z, avx._mm512_mul_pd(push, dz)),
        ];
    }

    /// The largest overlaps over a radius, and others.
    #[inline(always)]
    fn worst(&self, simd: V4, radius: f64, others: __m256d) -> __m256d {
        let avx = simd.avx;
        let [first, second]: [__m256d; 2] = cast(self.overlap);
        let largest = avx._mm256_max_pd(first, second);
        let in_radii = avx._mm256_div_pd(largest, avx._mm256_set1_pd(radius));
        avx._mm256_max_pd(in_radii, others)
    }

    /// The total force.
    #[inline(always)]
    fn sum(&self) -> [f64; 3] {
        let [x, y, z]: [[f64; LANES]; 3] = cast(self.force);
        [x.iter().sum(), y.iter().sum(), z.iter().sum()]
    }
}

/// A sum, with the first half of eight numbers added to it and then the second.
#[inline(always)]
fn add_halves(simd: V4, sum: __m256d, eight: __m512d) -> __m256d {
    let [first, second]: [__m256d; 2] = cast(eight);
    let sum = simd.avx._mm256_add_pd(sum, first);
    simd.avx._mm256_add_pd(sum, second)
}

/// The columns of eight spheres.
#[inline(always)]
fn columns(simd: V4, groups: &[[u32; LANES]; 2], balls: &[ReducedSphere]) -> [__m512d; 4] {
    let avx = simd.avx512f;
    let [[a, b, c, d], [e, f, g, h]] = *groups;
    // Two rows share a register, so that its halves need not be exchanged.
    let r02: __m512d = cast([balls[a as usize], balls[c as usize]]);
    let r13: __m512d = cast([balls[b as usize], balls[d as usize]]);
    let r46: __m512d = cast([balls[e as usize], balls[g as usize]]);
    let r57: __m512d = cast([balls[f as usize], balls[h as usize]]);
    let low = avx._mm512_unpacklo_pd(r02, r13);
    let high = avx._mm512_unpackhi_pd(r02, r13);
    let low_2 = avx._mm512_unpacklo_pd(r46, r57);
    let high_2 = avx._mm512_unpackhi_pd(r46, r57);
    [
        avx._mm512_shuffle_f64x2::<0b10_00_10_00>(low, low_2),
        avx._mm512_shuffle_f64x2::<0b10_00_10_00>(high, high_2),
        avx._mm512_shuffle_f64x2::<0b11_01_11_01>(low, low_2),
        avx._mm512_shuffle_f64x2::<0b11_01_11_01>(high, high_2),
    ]
}
