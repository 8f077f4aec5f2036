//! Random points in a box, the spheres that cover them and their depth.
//!
//! The box is cut into equal cells with two random points each (stratified sampling, the same
//! points for the same box).

use super::bonded_packing::BondedPacking;
use super::depth::{DepthProbe, DepthQuery};
use dem_io::random::nth;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Largest number of cells, for regions that fill little of their box.
const MOST_CELLS: f64 = 4e6;
const SPHERES_PER_TASK: usize = 1024;
const ROWS_PER_TASK: usize = 16;

/// The two points of a cell.
pub(super) struct Pair {
    /// The smallest corner of the cell, local units.
    pub(super) corner: [f64; 3],
    /// Their positions, local units.
    pub(super) points: [[f64; 3]; 2],
    /// Their depths, as exact as the question requires.
    pub(super) depths: [f64; 2],
    /// True if covered by spheres of true radius.
    pub(super) in_union: [bool; 2],
    /// True if covered by spheres reduced to r_gen.
    pub(super) in_generating: [bool; 2],
}

/// An axis-parallel box from one corner to another, local units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Box3 {
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
}

impl Box3 {
    /// An empty box, to be enlarged.
    pub(super) const EMPTY: Self = Self {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    /// Enlarges it to contain another.
    pub(super) fn add(&mut self, other: &Self) {
        for k in 0..3 {
            self.low[k] = self.low[k].min(other.low[k]);
            self.high[k] = self.high[k].max(other.high[k]);
        }
    }

    /// Lengths of its edges.
    pub(super) fn size(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| self.high[k] - self.low[k])
    }
}

/// Cells of a box, x fastest.
pub(super) struct Cells {
    low: [f64; 3],
    count: [usize; 3],
    /// Edges of a cell, local units.
    pub(super) step: [f64; 3],
}

impl Cells {
    /// The number of cells is chosen so that about `points` random points fall into a region of
    /// `volume` within the box.
    pub(super) fn new(within: &Box3, volume: f64, points: f64) -> Self {
        let size = within.size();
        let box_volume: f64 = size.iter().product();
        let wanted = (0.5 * points * box_volume / volume).clamp(1.0, MOST_CELLS);
        let edge = (box_volume / wanted).cbrt();
        let count = size.map(|e| ((e / edge).round() as usize).max(1));
        let step = [0, 1, 2].map(|k| size[k] / count[k] as f64);
        Self {
            low: within.low,
            count,
            step,
        }
    }

    fn index(&self, x: usize, y: usize, z: usize) -> usize {
        x + self.count[0] * (y + self.count[1] * z)
    }

    /// The smallest corner of a cell.
    fn corner(&self, cell: [usize; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| self.low[k] + cell[k] as f64 * self.step[k])
    }

    /// The two random points of a cell.
    fn points(&self, cell: [usize; 3]) -> [[f64; 3]; 2] {
        let index = self.index(cell[0], cell[1], cell[2]) as u64;
        let corner = self.corner(cell);
        let mut points = [[0.0; 3]; 2];
        for k in 0..3 {
            let random = nth(3 * index + k as u64);
            let fractions = [(random >> 32) as f64, (random & 0xffff_ffff) as f64];
            for (point, fraction) in points.iter_mut().zip(fractions) {
                point[k] = corner[k] + (fraction + 0.5) / 4_294_967_296.0 * self.step[k];
            }
        }
        points
    }

    /// The cells along `axis` that `[from, to]` reaches.
    fn range(&self, axis: usize, from: f64, to: f64) -> std::ops::Range<usize> {
        let cell = |x: f64| ((x - self.low[axis]) / self.step[axis]).floor();
        cell(from).max(0.0) as usize..((cell(to) + 1.0).max(0.0) as usize).min(self.count[axis])
    }
}

const GENERATING: [u8; 2] = [1, 4];
const UNION: [u8; 2] = [2, 8];

/// For each cell, which of its points lie in a sphere: bits as above, for the reduced and the true
/// radii.
fn cover(packing: &BondedPacking, cells: &Cells) -> Vec<AtomicU8> {
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

/// Calls `add` with all pairs of points, in parts whose order and extent are always the same.
/// Depths answer the question, see [`DepthProbe`].
pub(super) fn over_pairs<T: Default + Send>(
    packing: &BondedPacking,
    cells: &Cells,
    question: DepthQuery,
    add: impl Fn(&mut T, &Pair) + Sync,
) -> Vec<T> {
    let covered = cover(packing, cells);
    let rows: Vec<usize> = (0..cells.count[1] * cells.count[2]).collect();
    rows.par_chunks(ROWS_PER_TASK)
        .map(|rows| {
            let mut part = T::default();
            let mut probe = DepthProbe::new(packing, question);
            for row in rows {
                let (y, z) = (row % cells.count[1], row / cells.count[1]);
                for x in 0..cells.count[0] {
                    let bits = covered[cells.index(x, y, z)].load(Relaxed);
                    let points = cells.points([x, y, z]);
                    let pair = Pair {
                        corner: cells.corner([x, y, z]),
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
