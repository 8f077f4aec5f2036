//! Bonds are taken in blocks: what a block needs is gathered into short arrays side by side, computed without a branch (the compiler makes
//! vector code of it, for AVX2 where the machine has it), and added to the particles in the order of the bonds.

use std::ops::Range;

use nalgebra::Vector3;

use crate::state::particles::Wrench;
use crate::state::shares::Share;

/// Bonds in a block.
pub(super) const BLOCK: usize = 32;
/// Bonds computed at once, at least.
const LANES: usize = 4;

/// One number of each bond of a block.
pub(super) type Column = [f64; BLOCK];
/// Four numbers of each bond of a block.
pub(super) type Rows = [[f64; 4]; BLOCK];

/// Bonds to be computed where `count` are wanted: to the full number of lanes. What an earlier block left there does no harm.
#[inline(always)]
pub(super) fn full_lanes(count: usize) -> Range<usize> {
    0..count.next_multiple_of(LANES).min(BLOCK)
}

/// Asks for the cache line of a value that will be needed soon.
#[inline(always)]
#[expect(
    unsafe_code,
    reason = "a hint that reads and writes nothing; the safe language has none"
)]
pub(super) fn fetch_soon<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch has no effect but on the cache, whatever the address, and every x86-64 processor has it.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}

/// Works on all shares, on as many threads as there are; each has the wrenches of its own particles.
pub(super) fn for_each_share(
    shares: &mut [Share],
    wrenches: &mut [Wrench],
    work: &(impl Fn(&mut Share, &mut [Wrench]) + Sync),
) {
    match shares {
        [] => {}
        [share] => work(share, wrenches),
        _ => {
            let (left, right) = shares.split_at_mut(shares.len() / 2);
            let count = right[0].particles.start - left[0].particles.start;
            let (of_left, of_right) = wrenches.split_at_mut(count);
            rayon::join(
                || for_each_share(left, of_left, work),
                || for_each_share(right, of_right, work),
            );
        }
    }
}

/// What the bonds of a block do to their ends.
pub(super) struct Effects {
    force_on_b: Rows,
    torques: [Rows; 2],
}

impl Effects {
    pub(super) fn new() -> Self {
        let rows = [[0.0; 4]; BLOCK];
        Self {
            force_on_b: rows,
            torques: [rows; 2],
        }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, force_on_b: &Vector3<f64>, torques: &[Vector3<f64>; 2]) {
        let row = |v: &Vector3<f64>| [v.x, v.y, v.z, 0.0];
        self.force_on_b[i] = row(force_on_b);
        self.torques[0][i] = row(&torques[0]);
        self.torques[1][i] = row(&torques[1]);
    }

    /// Adds them to the particles of a share, in which all first ends lie. `wrenches` are those of the share.
    #[inline(always)]
    pub(super) fn add_to_both(
        &self,
        ends: impl Iterator<Item = [u32; 2]>,
        wrenches: &mut [Wrench],
        particles: &Range<usize>,
    ) {
        for (i, [a, b]) in (0..BLOCK).zip(ends) {
            let a = &mut wrenches[a as usize - particles.start];
            for k in 0..4 {
                a.force_n[k] -= self.force_on_b[i][k];
                a.torque_n_m[k] += self.torques[0][i][k];
            }
            if (b as usize) < particles.end {
                self.add_to_b(i, &mut wrenches[b as usize - particles.start]);
            }
        }
    }

    /// Adds them to the particles of a share, in which all second ends lie and no first.
    #[inline(always)]
    pub(super) fn add_to_second(
        &self,
        ends: impl Iterator<Item = [u32; 2]>,
        wrenches: &mut [Wrench],
        start: usize,
    ) {
        for (i, [_, b]) in (0..BLOCK).zip(ends) {
            self.add_to_b(i, &mut wrenches[b as usize - start]);
        }
    }

    #[inline(always)]
    fn add_to_b(&self, i: usize, b: &mut Wrench) {
        for k in 0..4 {
            b.force_n[k] += self.force_on_b[i][k];
            b.torque_n_m[k] += self.torques[1][i][k];
        }
    }
}
