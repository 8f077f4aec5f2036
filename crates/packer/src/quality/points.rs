//! Random points in the box of a shape, what covers them and how deep they lie.
//!
//! The bounding box is cut into equal cells with two random points each (stratified sampling, the same points for the
//! same box).

use super::Packing;
use super::depth::Probe;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// For shapes that fill little of their box.
const MOST_CELLS: f64 = 4e6;
const SPHERES_PER_TASK: usize = 1024;
const ROWS_PER_TASK: usize = 16;

/// What is known of the two points of a cell.
pub(super) struct Pair {
    /// Where they are, local units.
    pub(super) points: [[f64; 3]; 2],
    /// How deep they lie, as far as the probe was asked to tell.
    pub(super) depths: [f64; 2],
    /// Covered by spheres of true radius.
    pub(super) in_union: [bool; 2],
    /// Covered by spheres reduced to r_gen.
    pub(super) in_generating: [bool; 2],
}

/// Cells of the bounding box, x fastest.
pub(super) struct Cells {
    count: [usize; 3],
    step: [f64; 3],
}

impl Cells {
    /// So many cells that about `points` random points fall into the solid.
    pub(super) fn new(packing: &Packing, points: f64) -> Self {
        let extent = packing.extent;
        let box_volume: f64 = extent.iter().product();
        let wanted = (0.5 * points * box_volume / packing.shape_volume).clamp(1.0, MOST_CELLS);
        let edge = (box_volume / wanted).cbrt();
        let count = extent.map(|e| ((e / edge).round() as usize).max(1));
        let step = [0, 1, 2].map(|k| extent[k] / count[k] as f64);
        Self { count, step }
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        x + self.count[0] * (y + self.count[1] * z)
    }

    /// The two random points of a cell.
    fn points(&self, cell: [usize; 3]) -> [[f64; 3]; 2] {
        let index = self.index(cell[0], cell[1], cell[2]) as u64;
        let mut points = [[0.0; 3]; 2];
        for k in 0..3 {
            let random = mixed(3 * index + k as u64);
            let shares = [(random >> 32) as f64, (random & 0xffff_ffff) as f64];
            for (point, share) in points.iter_mut().zip(shares) {
                point[k] = (cell[k] as f64 + (share + 0.5) / 4_294_967_296.0) * self.step[k];
            }
        }
        points
    }

    /// The cells along `axis` that `[from, to]` reaches.
    fn range(&self, axis: usize, from: f64, to: f64) -> std::ops::RangeInclusive<usize> {
        let last = self.count[axis] - 1;
        let cell = |x: f64| ((x / self.step[axis]).max(0.0) as usize).min(last);
        cell(from)..=cell(to)
    }
}

/// A random number from a counter (splitmix64).
fn mixed(counter: u64) -> u64 {
    let mut z = counter.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

const GENERATING: [u8; 2] = [1, 4];
const UNION: [u8; 2] = [2, 8];

/// For each cell which of its points lie in a sphere: bits as above, for the reduced and the true radii.
fn cover(packing: &Packing, cells: &Cells) -> Vec<AtomicU8> {
    let covered: Vec<AtomicU8> = (0..cells.count.iter().product())
        .map(|_| AtomicU8::new(0))
        .collect();
    let shrink = 1.0 / (1.0 + packing.overlap).powi(2);
    let spheres = packing.spheres;
    spheres
        .positions
        .par_iter()
        .zip(&spheres.radii)
        .with_min_len(SPHERES_PER_TASK)
        .for_each(|(centre, radius)| {
            let squared = radius * radius;
            let [xs, ys, zs] =
                [0, 1, 2].map(|k| cells.range(k, centre[k] - radius, centre[k] + radius));
            for z in zs {
                for y in ys.clone() {
                    for x in xs.clone() {
                        let mut bits = 0;
                        for (i, point) in cells.points([x, y, z]).into_iter().enumerate() {
                            let distance: f64 =
                                (0..3).map(|k| (point[k] - centre[k]).powi(2)).sum();
                            bits |= if distance <= squared { UNION[i] } else { 0 };
                            bits |= if distance <= squared * shrink {
                                GENERATING[i]
                            } else {
                                0
                            };
                        }
                        if bits != 0 {
                            covered[cells.index(x, y, z)].fetch_or(bits, Relaxed);
                        }
                    }
                }
            }
        });
    covered
}

/// Shows all pairs of points to `add`, in parts whose order and extent are always the same. Depths are told exactly
/// between `floor` and `cap` only, see [`Probe`].
pub(super) fn over_pairs<T: Default + Send>(
    packing: &Packing,
    cells: &Cells,
    [floor, cap]: [f64; 2],
    add: impl Fn(&mut T, &Pair) + Sync,
) -> Vec<T> {
    let covered = cover(packing, cells);
    let rows: Vec<usize> = (0..cells.count[1] * cells.count[2]).collect();
    rows.par_chunks(ROWS_PER_TASK)
        .map(|rows| {
            let mut part = T::default();
            let mut probe = Probe::new(packing, floor, cap);
            for row in rows {
                let (y, z) = (row % cells.count[1], row / cells.count[1]);
                for x in 0..cells.count[0] {
                    let bits = covered[cells.index(x, y, z)].load(Relaxed);
                    let points = cells.points([x, y, z]);
                    let pair = Pair {
                        points,
                        depths: points.map(|point| probe.depth(point)),
                        in_union: UNION.map(|bit| bits & bit != 0),
                        in_generating: GENERATING.map(|bit| bits & bit != 0),
                    };
                    add(&mut part, &pair);
                }
            }
            part
        })
        .collect()
}
