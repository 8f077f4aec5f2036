//! Bonds are processed eight at a time: the data of their ends are gathered from memory row by row,
//! computed lane by lane, and added to the particles in the order of the bonds.

use std::ops::Range;

use crate::state::bonds::{BLOCK, Bonds};
use crate::state::particles::{Pose, Wrench};
use crate::state::partitions::Partition;
use crate::threads::for_each;
use dem_physics::lanes::{Lanes, MOST};
use dem_physics::number::Vec3;

/// Eight bonds, some of which are wanted.
pub(super) struct BondGroup {
    /// Their numbers. If there are fewer than eight, one of them fills the empty places.
    pub(super) numbers: [usize; BLOCK],
    /// Their two particles.
    pub(super) ends: [[u32; 2]; BLOCK],
    /// Places of the wanted bonds.
    pub(super) wanted: Range<usize>,
}

/// Places in a block.
const PLACES: [usize; BLOCK] = [0, 1, 2, 3, 4, 5, 6, 7];

impl BondGroup {
    /// The bonds of a block; those in `range` are wanted.
    #[inline(always)]
    pub(super) fn of_block(bonds: &Bonds, block: usize, range: &Range<usize>) -> Self {
        let (first, last) = (block * BLOCK, bonds.len() - 1);
        let numbers = PLACES.map(|i| (first + i).min(last));
        let ends = match bonds.ends[first..].first_chunk() {
            Some(ends) => *ends,
            None => numbers.map(|at| bonds.ends[at]),
        };
        Self {
            numbers,
            ends,
            wanted: range.start.saturating_sub(first)..(range.end - first).min(BLOCK),
        }
    }

    /// The bonds of a short list: one to eight.
    #[inline(always)]
    pub(super) fn of_list(bonds: &Bonds, some: &[u32]) -> Self {
        let numbers = PLACES.map(|i| some[i.min(some.len() - 1)] as usize);
        Self {
            numbers,
            ends: numbers.map(|at| bonds.ends[at]),
            wanted: 0..some.len(),
        }
    }

    /// Whether any of the bonds from `first` on, one for each lane, is wanted.
    #[inline(always)]
    pub(super) fn any_wanted<T: Lanes>(&self, first: usize) -> bool {
        self.wanted.start < first + T::COUNT && first < self.wanted.end
    }

    /// A bit for each place, lowest first: whether its bond is wanted.
    #[inline(always)]
    fn wanted_bits(&self) -> u32 {
        let below = |place: usize| (1_u32 << place) - 1;
        below(self.wanted.end) & !below(self.wanted.start)
    }

    /// Adds the wrenches of the bonds from `first` on, one for each lane, to those of their ends
    /// that are particles of a partition. `wrenches` are those of the partition, whose first
    /// particle is `start`. Torques act on both ends. The force acts on the second end; the first
    /// feels the opposite force.
    #[inline(always)]
    pub(super) fn add<T: Lanes>(
        &self,
        first: usize,
        force_on_b: Vec3<T>,
        torques: [Vec3<T>; 2],
        wrenches: &mut [Wrench],
        start: usize,
    ) {
        let force_on_b = rows(force_on_b);
        let (torque_on_a, torque_on_b) = (rows(torques[0]), rows(torques[1]));
        let wanted = self.wanted_bits();
        for lane in 0..T::COUNT {
            if wanted >> (first + lane) & 1 == 0 {
                continue;
            }
            // An end in another partition has no place in `wrenches`.
            let [a, b] = self.ends[first + lane].map(|end| (end as usize).wrapping_sub(start));
            if let Some(a) = wrenches.get_mut(a) {
                for k in 0..4 {
                    a.force_n[k] -= force_on_b[lane][k];
                    a.torque_n_m[k] += torque_on_a[lane][k];
                }
            }
            if let Some(b) = wrenches.get_mut(b) {
                for k in 0..4 {
                    b.force_n[k] += force_on_b[lane][k];
                    b.torque_n_m[k] += torque_on_b[lane][k];
                }
            }
        }
    }
}

/// Blocks that contain bonds of a range.
#[inline(always)]
pub(super) fn blocks_of(range: &Range<usize>) -> Range<usize> {
    range.start / BLOCK..range.end.div_ceil(BLOCK)
}

/// Vectors from columns x, y, z of rows.
#[inline(always)]
pub(crate) fn vectors<T: Lanes>(proof: T::Proof, rows: impl Fn(usize) -> [f64; 4]) -> Vec3<T> {
    let [x, y, z, _] = T::columns(proof, rows);
    Vec3(x, y, z)
}

/// Rows of x, y, z and a fourth number for padding.
#[inline(always)]
pub(crate) fn rows<T: Lanes>(vectors: Vec3<T>) -> [[f64; 4]; MOST] {
    T::rows([vectors.0, vectors.1, vectors.2, vectors.0])
}

/// Vectors from the first to the second ends, m, one for each lane.
#[inline(always)]
pub(super) fn separations<T: Lanes>(proof: T::Proof, ends: &[[u32; 2]], poses: &[Pose]) -> Vec3<T> {
    vectors(proof, |lane| {
        let [a, b] = ends[lane].map(|end| &poses[end as usize].position_m);
        [0, 1, 2, 3].map(|k| b[k] - a[k])
    })
}

/// Prefetches the cache line of one of many values that will be needed soon. Whether there is such
/// a value is not checked, which would take longer: a particle of another partition has its wrench
/// fetched too.
#[inline(always)]
#[expect(
    unsafe_code,
    reason = "a hint that reads and writes nothing; the safe language has none"
)]
pub(crate) fn fetch_soon_of<T>(all: &[T], i: usize) {
    let line = all.as_ptr().wrapping_add(i);
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch affects only the cache, whatever the address, and every x86-64 processor
    // has it.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(line.cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = line;
}

/// Prefetch distance, in bonds.
const AHEAD: usize = 64;

/// Second ends of the bonds that follow a block soon. In a large body they are far away in memory,
/// while first ends follow one another: they are to be prefetched.
#[inline(always)]
pub(super) fn coming_second_ends(bonds: &Bonds, block: usize) -> impl Iterator<Item = usize> {
    let coming = bonds.ends.get(block * BLOCK + AHEAD..);
    let coming: Option<&[[u32; 2]; BLOCK]> = coming.and_then(<[_]>::first_chunk);
    coming.into_iter().flatten().map(|&[_, b]| b as usize)
}

/// Works on all partitions, on as many threads as there are. Each gets the wrenches of its own
/// particles.
pub(super) fn for_each_partition(
    partitions: &mut [Partition],
    mut wrenches: &mut [Wrench],
    work: &(impl Fn(&mut Partition, &mut [Wrench]) + Sync),
) {
    let parts = partitions.iter_mut().map(|partition| {
        let own = wrenches.split_off_mut(..partition.particles.len());
        (partition, own.unwrap_or_default())
    });
    for_each(parts, |(partition, wrenches)| work(partition, wrenches));
}
