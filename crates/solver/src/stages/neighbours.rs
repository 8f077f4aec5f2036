//! The Verlet list: pairs of particles of different clusters that may touch before one of them is
//! searched for again.
//!
//! Each particle has a ball around the place where it was at its last search: larger than the
//! particle by the distance that it may move until the next. Two particles are a pair if their
//! balls overlap. When some particles have used up their distance, only these get new balls and
//! are searched for.
//!
//! Two large clusters are searched only where their boxes overlap, body by body. Small clusters,
//! and large ones where they may meet small ones, are put into grids.

mod grid;
mod meetings;

use rayon::prelude::*;

use self::grid::{Grids, Seeker};
use self::meetings::Meetings;
use super::chunks::CHUNK;
use super::lanes::{LaneWork, Lanes, with_most_lanes};
use crate::geometry::Bounds;
use crate::physics::number::Vec3;
use crate::state::groups::{BLOCK, BOXES, KnownClusters, LargeCluster, NOWHERE};
use crate::state::particles::Pose;
use crate::state::references::Ball;

/// Pairs of particles of different clusters whose surfaces are less than `skin_m` apart, the
/// smaller index first, sorted. `clusters`: one for each particle.
pub fn near_pairs(poses: &[Pose], clusters: &[u32], skin_m: f64) -> Vec<[u32; 2]> {
    let ball = |pose: &Pose| {
        let [x, y, z, radius_m] = pose.position_m;
        [x, y, z, radius_m + 0.5 * skin_m]
    };
    let balls: Vec<Ball> = poses.iter().map(ball).collect();
    let mut known = KnownClusters::default();
    known.update(&balls, clusters, None);
    overlapping_pairs(&balls, clusters, None, &known)
}

/// Pairs of overlapping balls of different clusters, the smaller index first, sorted; with `seeks`
/// (one for each ball) only those with at least one ball that seeks. `clusters`: one for each ball.
/// `known`: of these balls.
pub(crate) fn overlapping_pairs(
    balls: &[Ball],
    clusters: &[u32],
    seeks: Option<&[bool]>,
    known: &KnownClusters,
) -> Vec<[u32; 2]> {
    let search = Search {
        balls,
        clusters,
        seeks,
        known,
    };
    let mut pairs = search.among_small();
    let of_large: Vec<Vec<[u32; 2]>> = (0..known.large.len())
        .into_par_iter()
        .map(|n| search.of_large(n))
        .collect();
    pairs.extend(of_large.into_iter().flatten());
    if !pairs.is_sorted() {
        pairs.par_sort_unstable();
    }
    pairs
}

/// What is searched.
struct Search<'a> {
    balls: &'a [Ball],
    clusters: &'a [u32],
    seeks: Option<&'a [bool]>,
    known: &'a KnownClusters,
}

impl Search<'_> {
    fn seeks(&self, i: u32) -> bool {
        self.seeks.is_none_or(|seeks| seeks[i as usize])
    }

    fn seeker(&self, i: u32) -> Seeker {
        Seeker {
            particle: i,
            cluster: self.clusters[i as usize],
            ball: self.balls[i as usize],
        }
    }

    /// Pairs of the large cluster of this place in the list with those that come after it.
    fn of_large(&self, n: usize) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        with_most_lanes(LargeMeetings {
            search: self,
            of: n,
            pairs: &mut pairs,
        });
        pairs
    }

    /// Pairs of which at least one is of a small cluster.
    fn among_small(&self) -> Vec<[u32; 2]> {
        let groups = &self.known.groups;
        let active = Meetings::new(self.balls, self.known, self.seeks).with_small(self.balls);
        if active.len() < 2 {
            return Vec::new();
        }
        let grids = Grids::new(self.balls, self.clusters, &active);
        let is_large = |i: u32| groups.is_large(self.clusters[i as usize]);
        let any_large = !self.known.large.is_empty();
        let of_chunk = |some: &[u32]| {
            let mut pairs = Vec::new();
            for &i in some.iter().filter(|i| self.seeks(**i)) {
                let seeker = self.seeker(i);
                match self.seeks {
                    None => grids.add_pairs_of_all(&seeker, &mut pairs),
                    Some(seeks) => grids.add_pairs(&seeker, |j| seeks[j as usize], &mut pairs),
                }
            }
            if any_large {
                pairs.retain(|&[a, b]| !(is_large(a) && is_large(b)));
            }
            pairs.sort_unstable();
            pairs
        };
        let chunks: Vec<Vec<[u32; 2]>> = active.par_chunks(CHUNK).map(of_chunk).collect();
        chunks.concat()
    }
}

/// Meetings of a large cluster with those that come after it in the list.
struct LargeMeetings<'a> {
    search: &'a Search<'a>,
    of: usize,
    pairs: &'a mut Vec<[u32; 2]>,
}

impl LaneWork for LargeMeetings<'_> {
    #[inline(always)]
    fn with<T: Lanes>(mut self, proof: T::Proof) {
        let large = &self.search.known.large;
        let a = &large[self.of];
        let reaches = |b: &&LargeCluster| b.bounds.low[0] <= a.bounds.high[0];
        for b in large[self.of + 1..].iter().take_while(reaches) {
            if (a.seeks || b.seeks) && a.bounds.overlaps(&b.bounds) {
                self.meet::<T>(proof, a, b);
            }
        }
    }
}

impl LargeMeetings<'_> {
    /// Adds the pairs of two clusters: those of their blocks that overlap.
    #[inline(always)]
    fn meet<T: Lanes>(&mut self, proof: T::Proof, a: &LargeCluster, b: &LargeCluster) {
        let mut room = a.bounds.common(&b.bounds);
        // What one of them has there narrows down where the other can meet it.
        for large in [a, b] {
            let mut there = Bounds::EMPTY;
            for some in 0..large.boxes.len() {
                let mut bits = within::<T>(proof, &large.boxes[some], &room);
                while bits != 0 {
                    include(&mut there, &large.blocks[some * BOXES + next_of(&mut bits)]);
                }
            }
            room = room.common(&there);
            if room == Bounds::EMPTY {
                return;
            }
        }
        for some_a in 0..a.boxes.len() {
            let mut bits_a = within::<T>(proof, &a.boxes[some_a], &room);
            while bits_a != 0 {
                let of_a = some_a * BOXES + next_of(&mut bits_a);
                let room = room.common(&a.blocks[of_a]);
                let of_a = Members::of::<T>(proof, a, of_a, self.search);
                for some_b in 0..b.boxes.len() {
                    let mut bits_b = within::<T>(proof, &b.boxes[some_b], &room);
                    while bits_b != 0 {
                        let of_b = some_b * BOXES + next_of(&mut bits_b);
                        self.test::<T>(proof, &of_a, b, of_b);
                    }
                }
            }
        }
    }

    /// Tests the balls of a block that reach into the box of a block of another cluster against its
    /// balls, one of these for each lane.
    #[inline(always)]
    fn test<T: Lanes>(
        &mut self,
        proof: T::Proof,
        of_a: &Members<'_>,
        b: &LargeCluster,
        block_of_b: usize,
    ) {
        let mut reaching = reaching::<T>(proof, &of_a.columns, &b.blocks[block_of_b]);
        if reaching == 0 {
            return;
        }
        let of_b = Members::of::<T>(proof, b, block_of_b, self.search);
        while reaching != 0 {
            let n = next_of(&mut reaching);
            // Spelled out: a closure around lanes may not be compiled for them.
            let [x, y, z, radius_m] = [
                T::all(proof, of_a.columns[0][n]),
                T::all(proof, of_a.columns[1][n]),
                T::all(proof, of_a.columns[2][n]),
                T::all(proof, of_a.columns[3][n]),
            ];
            for first in (0..BLOCK).step_by(T::COUNT) {
                let apart = Vec3(
                    T::load(proof, &of_b.columns[0], first) - x,
                    T::load(proof, &of_b.columns[1], first) - y,
                    T::load(proof, &of_b.columns[2], first) - z,
                );
                let near = radius_m + T::load(proof, &of_b.columns[3], first);
                let mut bits = u32::from((near * near).above(apart.square()));
                while bits != 0 {
                    let lane = next_of(&mut bits);
                    let [i, j] = [of_a.numbers[n], of_b.numbers[first + lane]];
                    if self.search.seeks(i) || self.search.seeks(j) {
                        self.pairs.push([i.min(j), i.max(j)]);
                    }
                }
            }
        }
    }
}

/// The balls of a block.
struct Members<'a> {
    /// Their numbers.
    numbers: &'a [u32],
    /// The balls by columns, x, y, z and radius, m, filled up with [`NOWHERE`].
    columns: [[f64; BLOCK]; 4],
}

impl<'a> Members<'a> {
    #[inline(always)]
    fn of<T: Lanes>(
        proof: T::Proof,
        large: &LargeCluster,
        block: usize,
        search: &Search<'a>,
    ) -> Self {
        let numbers = large.members(block, &search.known.groups);
        let mut columns = [[0.0; BLOCK]; 4];
        for first in (0..BLOCK).step_by(T::COUNT) {
            let lanes = T::columns(proof, |lane| match numbers.get(first + lane) {
                Some(&i) => search.balls[i as usize],
                None => NOWHERE,
            });
            for (column, lanes) in columns.iter_mut().zip(lanes) {
                column[first..first + T::COUNT].copy_from_slice(&lanes.values()[..T::COUNT]);
            }
        }
        Self { numbers, columns }
    }
}

/// The place of the lowest of some bits, which is cleared.
#[inline(always)]
fn next_of(bits: &mut u32) -> usize {
    let lowest = bits.trailing_zeros() as usize;
    *bits &= *bits - 1;
    lowest
}

/// Enlarges a box so that it contains another. None of the numbers may be NaN.
#[inline(always)]
fn include(all: &mut Bounds, one: &Bounds) {
    // Comparisons, which are one operation each.
    for k in 0..3 {
        let (low, high) = (one.low[k], one.high[k]);
        all.low[k] = if low < all.low[k] { low } else { all.low[k] };
        all.high[k] = if high > all.high[k] {
            high
        } else {
            all.high[k]
        };
    }
}

/// A bit for each of some boxes that overlaps `room`.
#[inline(always)]
fn within<T: Lanes>(proof: T::Proof, boxes: &[[f64; BOXES]; 6], room: &Bounds) -> u32 {
    let mut bits = 0;
    for first in (0..BOXES).step_by(T::COUNT) {
        let mut inside = u8::MAX;
        for k in 0..3 {
            inside &= T::all(proof, room.high[k]).above(T::load(proof, &boxes[k], first));
            inside &= T::load(proof, &boxes[3 + k], first).above(T::all(proof, room.low[k]));
        }
        bits |= u32::from(inside) << first;
    }
    bits
}

/// A bit for each ball of a block that reaches into a box.
#[inline(always)]
fn reaching<T: Lanes>(proof: T::Proof, columns: &[[f64; BLOCK]; 4], room: &Bounds) -> u32 {
    let mut bits = 0;
    for first in (0..BLOCK).step_by(T::COUNT) {
        let radius_m = T::load(proof, &columns[3], first);
        let mut inside = u8::MAX;
        for (column, (low, high)) in columns.iter().zip(room.low.iter().zip(&room.high)) {
            let c = T::load(proof, column, first);
            inside &= (c + radius_m).above(T::all(proof, *low));
            inside &= T::all(proof, *high).above(c - radius_m);
        }
        bits |= u32::from(inside) << first;
    }
    bits
}
