//! Pairs of small clusters, and of these with large ones, by grids.

use crate::state::search::clusters::{KnownClusters, Searched};
use dem_physics::geometry::balls::Ball;
use dem_physics::geometry::grids::{Grid, Grids};
use dem_physics::lanes::{LaneWork, Lanes, next_of};
use dem_physics::number::Vec3;

/// Meetings of some balls with those of small clusters, which are in the grids.
pub(super) struct SmallMeetings<'a> {
    pub(super) searched: &'a Searched<'a>,
    pub(super) known: &'a KnownClusters,
    pub(super) grids: &'a Grids,
    /// Balls of small clusters, and those of large ones near them, with their numbers.
    pub(super) some: &'a [(u32, Ball)],
    /// Their pairs, the smaller number first, sorted.
    pub(super) found: &'a mut Vec<[u32; 2]>,
}

impl LaneWork for SmallMeetings<'_> {
    #[inline(always)]
    fn with<T: Lanes>(mut self, proof: T::Proof) {
        self.found.clear();
        for &(i, ball) in self.some {
            let is_large = self.is_in_large(i);
            if is_large || self.searched.is_seeking(i) {
                self.meet::<T>(proof, i, ball, is_large);
            }
        }
        self.found.sort_unstable_by_key(in_order);
    }
}

impl SmallMeetings<'_> {
    /// Adds the pairs of a ball. A ball of a large cluster adds all of its pairs with small ones. Of
    /// two of small clusters, one that seeks adds the pair; of two that both seek, the one of the
    /// level of smaller balls, within a level the one with the smaller number.
    #[inline(always)]
    fn meet<T: Lanes>(&mut self, proof: T::Proof, i: u32, ball: Ball, is_large: bool) {
        let own = self.grids.level_of(ball[3]);
        for (level, grid) in self.grids.levels().iter().enumerate() {
            let others_add = !is_large && level > own && self.searched.seeks.is_none();
            if grid.particles.is_empty() || others_add {
                continue;
            }
            for row in grid.rows_near(ball) {
                for first in row.clone().step_by(T::COUNT) {
                    let mut bits = overlapping::<T>(proof, grid, first, ball);
                    while bits != 0 {
                        let at = first + next_of(&mut bits);
                        if at >= row.end {
                            break;
                        }
                        let j = grid.particles[at];
                        let is_added = if is_large {
                            self.searched.is_seeking(i) || self.searched.is_seeking(j)
                        } else {
                            let other_adds = level > own || level == own && j < i;
                            self.are_apart([i, j]) && !(other_adds && self.searched.is_seeking(j))
                        };
                        if is_added {
                            self.found.push([i.min(j), i.max(j)]);
                        }
                    }
                }
            }
        }
    }

    /// Whether a particle is of a large cluster.
    #[inline(always)]
    fn is_in_large(&self, i: u32) -> bool {
        let cluster = self.searched.clusters[i as usize];
        !self.known.large.is_empty() && self.known.groups.is_large(cluster)
    }

    /// Whether two particles are of different clusters.
    #[inline(always)]
    fn are_apart(&self, pair: [u32; 2]) -> bool {
        let [of_i, of_j] = pair.map(|i| self.searched.clusters[i as usize]);
        of_i != of_j
    }
}

/// A number by which pairs are sorted. It is compared faster than two.
pub(super) fn in_order(&[i, j]: &[u32; 2]) -> u64 {
    u64::from(i) << 32 | u64::from(j)
}

/// A bit for each of the balls of a grid from place `first` on that a ball overlaps, whether or not
/// they are in the same row.
#[inline(always)]
fn overlapping<T: Lanes>(proof: T::Proof, grid: &Grid, first: usize, ball: Ball) -> u32 {
    let [x, y, z, radius_m] = &grid.columns;
    let apart = Vec3(
        T::load(proof, x, first) - T::all(proof, ball[0]),
        T::load(proof, y, first) - T::all(proof, ball[1]),
        T::load(proof, z, first) - T::all(proof, ball[2]),
    );
    let near = T::all(proof, ball[3]) + T::load(proof, radius_m, first);
    u32::from((near * near).above(apart.square()))
}
