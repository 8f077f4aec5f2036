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

mod among_small;
mod meetings;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

use self::among_small::{SmallMeetings, in_order};
use self::meetings::list_with_small;
use crate::stages::chunks::{chunk_of, chunks_of, in_tasks, nth_range};
use crate::state::particles::Pose;
use crate::state::search::buffers::{PairBuffers, PairTask};
use crate::state::search::clusters::{KnownClusters, LargeCluster, Searched};
use crate::state::search::rigid_balls::Placement;
use dem_physics::geometry::Bounds;
use dem_physics::geometry::balls::{BLOCK, BOXES, Ball, BoxColumns, NOWHERE};
use dem_physics::lanes::{LaneWork, Lanes, next_of, with_most_lanes};
use dem_physics::number::Vec3;

/// Largest number of tasks that large clusters are divided into.
pub(super) const MOST_TASKS: usize = 256;

/// Pairs of particles of different clusters whose surfaces are less than `skin_m` apart, the
/// smaller index first, sorted. `clusters`: one for each particle.
pub fn near_pairs(poses: &[Pose], clusters: &[u32], skin_m: f64) -> Vec<[u32; 2]> {
    let balls = poses.iter().map(|pose| ball_of(pose, skin_m));
    let balls: Vec<Ball> = balls.collect();
    let mut buffers = PairBuffers::default();
    let mut known = KnownClusters::default();
    find_pairs_of_all(&balls, clusters, &mut known, &mut buffers);
    buffers.found
}

/// A sphere with half of a skin, m.
pub(super) fn ball_of(pose: &Pose, skin_m: f64) -> Ball {
    let [x, y, z, radius_m] = pose.position_m;
    [x, y, z, radius_m + 0.5 * skin_m]
}

/// Finds the pairs of overlapping balls of different clusters, the smaller index first, sorted.
/// `clusters`: one for each ball; `known`: kept for its memory.
pub(super) fn find_pairs_of_all(
    balls: &[Ball],
    clusters: &[u32],
    known: &mut KnownClusters,
    buffers: &mut PairBuffers,
) {
    let searched = Searched {
        balls,
        clusters,
        clusters_ever: None,
        seeks: None,
        asleep: &[],
        clumps: None,
    };
    known.update(&searched);
    find_pairs(&searched, known, buffers);
}

/// Finds the pairs of overlapping balls of different clusters, the smaller index first, sorted:
/// those with at least one ball that seeks. `known`: of these balls.
pub(crate) fn find_pairs(
    searched: &Searched<'_>,
    known: &KnownClusters,
    buffers: &mut PairBuffers,
) {
    let search = Search { searched, known };
    buffers.found.clear();
    search.among_small(buffers);
    search.among_large(buffers);
    let pairs = &mut buffers.found;
    if !pairs.is_sorted() {
        pairs.par_sort_unstable_by_key(in_order);
    }
}

/// What is searched, and what is known of it.
struct Search<'a> {
    searched: &'a Searched<'a>,
    known: &'a KnownClusters,
}

impl<'a> Search<'a> {
    /// The balls of a block of a cluster, in its axes.
    #[inline(always)]
    fn members<T: Lanes>(
        &self,
        proof: T::Proof,
        large: &LargeCluster,
        block: usize,
    ) -> Members<'a> {
        let numbers = large.members(block, &self.known.groups);
        let mut gathered = [[0.0; BLOCK]; 4];
        let columns = *self.columns::<T>(proof, large, block, &mut gathered);
        Members { numbers, columns }
    }

    /// The balls of a block of a cluster by columns, in its axes: those of its template, or those
    /// `gathered`.
    #[inline(always)]
    fn columns<'b, T: Lanes>(
        &self,
        proof: T::Proof,
        large: &'b LargeCluster,
        block: usize,
        gathered: &'b mut [[f64; BLOCK]; 4],
    ) -> &'b [[f64; BLOCK]; 4] {
        if let Some(body) = &large.rigid {
            return &body.balls.columns[block];
        }
        let numbers = large.members(block, &self.known.groups);
        gather::<T>(proof, numbers, self.searched.balls, gathered);
        gathered
    }

    /// Pairs of two large clusters.
    fn among_large(&self, buffers: &mut PairBuffers) {
        let count = self.known.awake_large();
        let each = count.div_ceil(MOST_TASKS).max(1);
        let tasks = in_tasks(count.div_ceil(each), &mut buffers.of_tasks, |n, task| {
            task.found.clear();
            for of in nth_range(n, each, count) {
                with_most_lanes(LargeMeetings {
                    search: self,
                    of,
                    task,
                });
            }
        });
        for task in tasks {
            buffers.found.extend_from_slice(&task.found);
        }
    }

    /// Pairs of which at least one is of a small cluster.
    fn among_small(&self, buffers: &mut PairBuffers) {
        list_with_small(self.searched, self.known, buffers);
        let PairBuffers {
            of_small,
            active,
            grids,
            of_tasks,
            found: all,
            ..
        } = buffers;
        if of_small.is_empty() || active.len() < 2 {
            return;
        }
        grids.fill(of_small);
        let chunks = chunks_of(active.len());
        let tasks = in_tasks(chunks.len(), of_tasks, |chunk, task| {
            with_most_lanes(SmallMeetings {
                searched: self.searched,
                known: self.known,
                grids,
                some: &active[chunk_of(chunk, active.len())],
                found: &mut task.found,
            });
        });
        for task in tasks {
            all.extend_from_slice(&task.found);
        }
    }
}

/// Meetings of a large cluster with those that come after it in the list.
struct LargeMeetings<'a> {
    search: &'a Search<'a>,
    of: usize,
    task: &'a mut PairTask,
}

/// How the first of two clusters lies in the axes of the second.
struct Relative {
    placement: Placement,
    /// What both add to the distance at which their balls overlap, m.
    allowance_m: f64,
}

impl LaneWork for LargeMeetings<'_> {
    #[inline(always)]
    fn with<T: Lanes>(mut self, proof: T::Proof) {
        let known = self.search.known;
        let a = known.nth_along_x(self.of);
        for (some, boxes) in known.columns.iter().enumerate().skip(self.of / BOXES) {
            if boxes[0][0] > a.bounds.high[0] {
                break;
            }
            let mut bits = within::<T>(proof, boxes, &a.bounds);
            while bits != 0 {
                let n = some * BOXES + next_of(&mut bits);
                if n <= self.of {
                    continue;
                }
                let b = known.nth_along_x(n);
                if a.seeks || b.seeks {
                    self.meet::<T>(proof, a, b);
                }
            }
        }
    }
}

impl Relative {
    /// None: both are in space.
    fn of(a: &LargeCluster, b: &LargeCluster) -> Option<Self> {
        let to_space = [a, b].map(LargeCluster::to_space);
        if to_space == [None; 2] {
            return None;
        }
        let [a_to_space, b_to_space] = to_space.map(|to| to.unwrap_or(&Placement::NONE));
        Some(Self {
            placement: a_to_space.seen_from(b_to_space),
            allowance_m: a.allowance_m() + b.allowance_m(),
        })
    }
}

impl LargeMeetings<'_> {
    /// Adds the pairs of two clusters: those of their blocks that overlap along the axes of both.
    #[inline(always)]
    fn meet<T: Lanes>(&mut self, proof: T::Proof, a: &LargeCluster, b: &LargeCluster) {
        let to_b = Relative::of(a, b);
        let mut room = bounds_at(a, to_b.as_ref()).common(&b.blocks.bounds);
        if room == Bounds::EMPTY {
            return;
        }
        let to_a = Relative::of(b, a);
        if !bounds_at(b, to_a.as_ref()).overlaps(&a.blocks.bounds) {
            return;
        }
        let mut placed = std::mem::take(&mut self.task.placed);
        let [placed_a, placed_b] = &mut placed;
        let a_in_b = all_at::<T>(proof, &a.blocks.columns, to_b.as_ref(), placed_a);
        // What one of them has there narrows down where the other can meet it.
        for boxes in [a_in_b, &b.blocks.columns] {
            room = room.common(&reach_within::<T>(proof, boxes, &room));
        }
        if room != Bounds::EMPTY {
            let b_in_a = all_at::<T>(proof, &b.blocks.columns, to_a.as_ref(), placed_b);
            for (some, boxes) in a_in_b.iter().enumerate() {
                let mut bits = within::<T>(proof, boxes, &room);
                while bits != 0 {
                    let lane = next_of(&mut bits);
                    let block = Block {
                        number: some * BOXES + lane,
                        in_a: box_at(&a.blocks.columns[some], lane),
                        in_b: box_at(boxes, lane),
                    };
                    self.meet_block::<T>(proof, (a, &block), (b, b_in_a), to_b.as_ref());
                }
            }
        }
        self.task.placed = placed;
    }

    /// Adds the pairs of a block of the first of two clusters with the second.
    #[inline(always)]
    fn meet_block<T: Lanes>(
        &mut self,
        proof: T::Proof,
        (a, block): (&LargeCluster, &Block),
        (b, b_in_a): (&LargeCluster, &[BoxColumns]),
        to_b: Option<&Relative>,
    ) {
        let mut of_a = None;
        for (some, (boxes, in_a)) in b.blocks.columns.iter().zip(b_in_a).enumerate() {
            let mut bits = within::<T>(proof, boxes, &block.in_b);
            if bits != 0 && to_b.is_some() {
                bits &= within::<T>(proof, in_a, &block.in_a);
            }
            while bits != 0 {
                let lane = next_of(&mut bits);
                if of_a.is_none() {
                    let members = self.search.members::<T>(proof, a, block.number);
                    of_a = Some(match to_b {
                        Some(to_b) => members.at::<T>(proof, to_b),
                        None => members,
                    });
                }
                let Some(of_a) = &of_a else { continue };
                let of_b = (b, some * BOXES + lane);
                self.test::<T>(proof, of_a, of_b, &box_at(boxes, lane));
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
        (b, block): (&LargeCluster, usize),
        bounds: &Bounds,
    ) {
        let mut reaching = reaching::<T>(proof, &of_a.columns, bounds);
        if reaching == 0 {
            return;
        }
        let numbers = b.members(block, &self.search.known.groups);
        let mut gathered = [[0.0; BLOCK]; 4];
        let of_b = self.search.columns::<T>(proof, b, block, &mut gathered);
        while reaching != 0 {
            let n = next_of(&mut reaching);
            // Spelled out: a closure around lanes may not be compiled for them.
            let [x, y, z, radius_m] = [
                T::all(proof, of_a.columns[0][n]),
                T::all(proof, of_a.columns[1][n]),
                T::all(proof, of_a.columns[2][n]),
                T::all(proof, of_a.columns[3][n]),
            ];
            let mut bits = 0;
            for first in (0..BLOCK).step_by(T::COUNT) {
                let apart = Vec3(
                    T::load(proof, &of_b[0], first) - x,
                    T::load(proof, &of_b[1], first) - y,
                    T::load(proof, &of_b[2], first) - z,
                );
                let near = radius_m + T::load(proof, &of_b[3], first);
                bits |= u32::from((near * near).above(apart.square())) << first;
            }
            while bits != 0 {
                let [i, j] = [of_a.numbers[n], numbers[next_of(&mut bits)]];
                if [i, j].iter().any(|&i| self.search.searched.is_seeking(i)) {
                    self.task.found.push([i.min(j), i.max(j)]);
                }
            }
        }
    }
}

/// A block of the first of two clusters.
struct Block {
    number: usize,
    /// Its box along its own axes, without allowance.
    in_a: Bounds,
    /// The same along the axes of the second, with the allowance of both.
    in_b: Bounds,
}

/// The balls of a block.
struct Members<'a> {
    /// Their numbers.
    numbers: &'a [u32],
    /// The balls by columns, x, y, z and radius, m, filled up with [`NOWHERE`].
    columns: [[f64; BLOCK]; 4],
}

impl Members<'_> {
    /// The same in the axes of another cluster, with the allowance of both.
    #[inline(always)]
    fn at<T: Lanes>(mut self, proof: T::Proof, relative: &Relative) -> Self {
        let Placement { turned, place_m } = &relative.placement;
        for first in (0..BLOCK).step_by(T::COUNT) {
            let [x, y, z, radius_m] = [
                T::load(proof, &self.columns[0], first),
                T::load(proof, &self.columns[1], first),
                T::load(proof, &self.columns[2], first),
                T::load(proof, &self.columns[3], first),
            ];
            for k in 0..3 {
                let turned =
                    x.scale(turned[(k, 0)]) + y.scale(turned[(k, 1)]) + z.scale(turned[(k, 2)]);
                put::<T>(&mut self.columns[k], first, turned.plus(place_m[k]));
            }
            let radius_m = radius_m.plus(relative.allowance_m);
            put::<T>(&mut self.columns[3], first, radius_m);
        }
        self
    }
}

/// Writes some balls by columns: see [`Members`].
#[inline(always)]
fn gather<T: Lanes>(
    proof: T::Proof,
    numbers: &[u32],
    balls: &[Ball],
    columns: &mut [[f64; BLOCK]; 4],
) {
    for first in (0..BLOCK).step_by(T::COUNT) {
        let lanes = T::columns(proof, |lane| match numbers.get(first + lane) {
            Some(&i) => balls[i as usize],
            None => NOWHERE,
        });
        for (column, lanes) in columns.iter_mut().zip(lanes) {
            put::<T>(column, first, lanes);
        }
    }
}

/// Writes lanes to a column, from place `first` on.
#[inline(always)]
fn put<T: Lanes>(column: &mut [f64], first: usize, lanes: T) {
    column[first..first + T::COUNT].copy_from_slice(&lanes.values()[..T::COUNT]);
}

/// The box around a cluster in the axes of another, with the allowance of both.
fn bounds_at(large: &LargeCluster, relative: Option<&Relative>) -> Bounds {
    let bounds = &large.blocks.bounds;
    relative.map_or(*bounds, |to| to.placement.of_box(bounds, to.allowance_m))
}

/// Boxes of a cluster in the axes of another, kept in `placed` if those differ.
#[inline(always)]
fn all_at<'a, T: Lanes>(
    proof: T::Proof,
    columns: &'a [BoxColumns],
    relative: Option<&Relative>,
    placed: &'a mut Vec<BoxColumns>,
) -> &'a [BoxColumns] {
    let Some(relative) = relative else {
        return columns;
    };
    placed.clear();
    for boxes in columns {
        placed.push(boxes_at::<T>(proof, boxes, relative));
    }
    placed
}

/// The boxes around some boxes of a cluster, in the axes of another, with the allowance of both.
#[inline(always)]
fn boxes_at<T: Lanes>(proof: T::Proof, boxes: &BoxColumns, relative: &Relative) -> BoxColumns {
    let Placement { turned, place_m } = &relative.placement;
    let mut placed = [[0.0; BOXES]; 6];
    for first in (0..BOXES).step_by(T::COUNT) {
        let [x0, y0, z0] = [
            T::load(proof, &boxes[0], first),
            T::load(proof, &boxes[1], first),
            T::load(proof, &boxes[2], first),
        ];
        let [x1, y1, z1] = [
            T::load(proof, &boxes[3], first),
            T::load(proof, &boxes[4], first),
            T::load(proof, &boxes[5], first),
        ];
        let centre = [
            (x0 + x1).scale(0.5),
            (y0 + y1).scale(0.5),
            (z0 + z1).scale(0.5),
        ];
        let half = [
            (x1 - x0).scale(0.5),
            (y1 - y0).scale(0.5),
            (z1 - z0).scale(0.5),
        ];
        for k in 0..3 {
            let row = [turned[(k, 0)], turned[(k, 1)], turned[(k, 2)]];
            let at = centre[0].scale(row[0]) + centre[1].scale(row[1]) + centre[2].scale(row[2]);
            let at = at.plus(place_m[k]);
            let row = row.map(f64::abs);
            let half = half[0].scale(row[0]) + half[1].scale(row[1]) + half[2].scale(row[2]);
            let half = half.plus(relative.allowance_m);
            put::<T>(&mut placed[k], first, at - half);
            put::<T>(&mut placed[3 + k], first, at + half);
        }
    }
    placed
}

/// The box around those of some boxes that overlap `room`.
#[inline(always)]
fn reach_within<T: Lanes>(proof: T::Proof, boxes: &[BoxColumns], room: &Bounds) -> Bounds {
    let mut there = Bounds::EMPTY;
    for boxes in boxes {
        let mut bits = within::<T>(proof, boxes, room);
        while bits != 0 {
            include(&mut there, &box_at(boxes, next_of(&mut bits)));
        }
    }
    there
}

/// One of some boxes.
#[inline(always)]
fn box_at(boxes: &BoxColumns, lane: usize) -> Bounds {
    Bounds {
        low: [boxes[0][lane], boxes[1][lane], boxes[2][lane]],
        high: [boxes[3][lane], boxes[4][lane], boxes[5][lane]],
    }
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
fn within<T: Lanes>(proof: T::Proof, boxes: &BoxColumns, room: &Bounds) -> u32 {
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
