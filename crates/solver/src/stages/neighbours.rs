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
use super::lanes::{LaneWork, Lanes, MOST, with_most_lanes};
use crate::geometry::Bounds;
use crate::physics::number::Vec3;
use crate::state::groups::{KnownClusters, LargeCluster, around, box_of};
use crate::state::particles::Pose;
use crate::state::references::Ball;

/// Up to this number of tests, two lists of balls are compared without a grid.
const FEW_TESTS: usize = 1 << 20;

/// Pairs of particles of different clusters whose surfaces are less than `skin_m` apart, the
/// smaller index first, sorted. `clusters`: one for each particle.
pub fn near_pairs(poses: &[Pose], clusters: &[u32], skin_m: f64) -> Vec<[u32; 2]> {
    let ball = |pose: &Pose| {
        let [x, y, z, radius_m] = pose.position_m;
        [x, y, z, radius_m + 0.5 * skin_m]
    };
    let balls: Vec<Ball> = poses.iter().map(ball).collect();
    overlapping_pairs(&balls, clusters, None, &mut KnownClusters::default())
}

/// Pairs of overlapping balls of different clusters, the smaller index first, sorted; with `seeks`
/// (one for each ball) only those with at least one ball that seeks. `clusters`: one for each ball.
/// `known`: of the last search; since then only balls that seek have changed.
pub(crate) fn overlapping_pairs(
    balls: &[Ball],
    clusters: &[u32],
    seeks: Option<&[bool]>,
    known: &mut KnownClusters,
) -> Vec<[u32; 2]> {
    known.update(balls, clusters, seeks);
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
        let a = &self.known.large[n];
        let mut pairs = Vec::new();
        let reaches = |b: &&LargeCluster| b.bounds.low[0] <= a.bounds.high[0];
        for b in self.known.large[n + 1..].iter().take_while(reaches) {
            if (a.seeks || b.seeks) && a.bounds.overlaps(&b.bounds) {
                let [of_a, of_b] = self.meeting_place(a, b);
                self.between(&of_a, &of_b, &mut pairs);
            }
        }
        pairs
    }

    /// The balls of each of two clusters that may overlap one of the other.
    fn meeting_place(&self, a: &LargeCluster, b: &LargeCluster) -> [Vec<u32>; 2] {
        let groups = &self.known.groups;
        let mut room = a.bounds.common(&b.bounds);
        // What one of them has there narrows down where the other can meet it.
        for large in [a, b, a, b] {
            room = room.common(&large.blocks_within(&room));
        }
        let mut of_a: Vec<u32> = a.within(&room, self.balls, groups).collect();
        room = room.common(&box_of(&of_a, self.balls));
        let of_b: Vec<u32> = b.within(&room, self.balls, groups).collect();
        room = box_of(&of_b, self.balls);
        of_a.retain(|&i| around(&self.balls[i as usize]).overlaps(&room));
        [of_a, of_b]
    }

    /// Adds the pairs between two lists of balls, of two clusters.
    fn between(&self, of_a: &[u32], of_b: &[u32], pairs: &mut Vec<[u32; 2]>) {
        if of_a.len() * of_b.len() > FEW_TESTS {
            let grids = Grids::new(self.balls, self.clusters, of_b);
            for &i in of_a {
                let counts = |j: u32| self.seeks(i) || self.seeks(j);
                grids.add_all_pairs(&self.seeker(i), counts, pairs);
            }
            return;
        }
        let mut columns = [0, 1, 2, 3].map(|k| {
            let column = of_b.iter().map(|&j| self.balls[j as usize][k]);
            column.collect::<Vec<f64>>()
        });
        for column in &mut columns {
            // So far away that nothing overlaps it.
            column.resize(of_b.len().next_multiple_of(MOST), f64::INFINITY);
        }
        with_most_lanes(AllTests {
            search: self,
            of_a,
            of_b,
            columns: &columns,
            pairs,
        });
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

/// Tests of all balls of a list against all of another: in groups of which the boxes overlap.
struct AllTests<'a> {
    search: &'a Search<'a>,
    of_a: &'a [u32],
    of_b: &'a [u32],
    /// Centres x, y, z and radii of the second list, m, padded to whole lanes.
    columns: &'a [Vec<f64>; 4],
    pairs: &'a mut Vec<[u32; 2]>,
}

impl LaneWork for AllTests<'_> {
    #[inline(always)]
    fn with<T: Lanes>(mut self, proof: T::Proof) {
        let search = self.search;
        let box_of = |some: &[u32]| box_of(some, search.balls);
        let boxes: Vec<Bounds> = self.of_b.chunks(MOST).map(box_of).collect();
        for some in self.of_a.chunks(MOST) {
            let room = box_of(some);
            for (n, _) in boxes.iter().enumerate().filter(|(_, b)| b.overlaps(&room)) {
                for first in (n * MOST..(n + 1) * MOST).step_by(T::COUNT) {
                    self.test::<T>(proof, some, first);
                }
            }
        }
    }
}

impl AllTests<'_> {
    /// Tests some balls against those in the lanes of the second list from `first` on.
    #[inline(always)]
    fn test<T: Lanes>(&mut self, proof: T::Proof, some: &[u32], first: usize) {
        let search = self.search;
        let [ox, oy, oz, other_m] = [0, 1, 2, 3].map(|k| T::load(proof, &self.columns[k], first));
        for &i in some {
            let [x, y, z, radius_m] = search.balls[i as usize].map(|c| T::all(proof, c));
            let apart = Vec3(ox - x, oy - y, oz - z);
            let near = radius_m + other_m;
            let mut bits = (near * near).above(apart.square());
            while bits != 0 {
                let j = self.of_b[first + bits.trailing_zeros() as usize];
                bits &= bits - 1;
                if search.seeks(i) || search.seeks(j) {
                    self.pairs.push([i.min(j), i.max(j)]);
                }
            }
        }
    }
}
