//! Densities by sampling: how much of the solid, of its interior and of its layers the spheres cover.
//!
//! The bounding box is cut into equal cells with two random points each (stratified sampling, the same points for the
//! same box). The standard error comes from the differences of the two points of a cell: for a region with indicator r,
//! cover c and share f = sum(c r)/sum(r), it is sqrt(sum over cells of ((c - f) r at one - (c - f) r at the other)^2)/sum(r).
//! Everything is counted in integers, so that the order of counting does not matter.

use super::Packing;
use super::depth::Probe;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// Points inside the solid, about: a standard error of 0.001 for the whole and for an interior of half of it.
const POINTS_IN_SOLID: f64 = 200_000.0;
/// For shapes that fill little of their box.
const MOST_CELLS: f64 = 4e6;
const LAYERS: usize = 20;
const LAYERS_PER_DIAMETER: f64 = 4.0;
const SLABS: usize = 10;
/// A region with fewer points than this has no density to speak of.
const FEWEST_POINTS: u64 = 100;
const SPHERES_PER_TASK: usize = 1024;
const ROWS_PER_TASK: usize = 16;

/// A share found by sampling.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Share {
    /// The share, 0 to 1.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// The density of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Where it begins, m.
    pub from_m: f64,
    /// Where it ends, m.
    pub to_m: f64,
    /// Its density. None if hardly a point fell into it.
    pub density: Option<Share>,
}

/// What the points say.
pub(super) struct Sampled {
    pub(super) union_density: Share,
    pub(super) interior_union_density: Option<Share>,
    pub(super) interior_generating_density: Option<Share>,
    pub(super) wall_profile: Vec<Layer>,
    pub(super) slab_profile: Vec<Layer>,
}

/// Counts of one region.
#[derive(Clone, Copy, Default)]
struct Tally {
    points: u64,
    covered: u64,
    /// Sums over cells of products of the differences of its two points, in cover (c) and in region (r).
    cover_cover: u64,
    cover_region: i64,
    region_region: u64,
}

impl Tally {
    /// Adds a cell: for each of its two points whether it is in the region, and whether there it is covered.
    fn add(&mut self, region: [bool; 2], covered: [bool; 2]) {
        if !(region[0] || region[1]) {
            return;
        }
        let r = region.map(i64::from);
        let c = [r[0] * i64::from(covered[0]), r[1] * i64::from(covered[1])];
        let (dr, dc) = (r[0] - r[1], c[0] - c[1]);
        self.points += (r[0] + r[1]) as u64;
        self.covered += (c[0] + c[1]) as u64;
        self.cover_cover += (dc * dc) as u64;
        self.cover_region += dc * dr;
        self.region_region += (dr * dr) as u64;
    }

    fn merge(&mut self, other: &Self) {
        self.points += other.points;
        self.covered += other.covered;
        self.cover_cover += other.cover_cover;
        self.cover_region += other.cover_region;
        self.region_region += other.region_region;
    }

    fn share(&self) -> Option<Share> {
        if self.points < FEWEST_POINTS {
            return None;
        }
        let points = self.points as f64;
        let value = self.covered as f64 / points;
        let squares = self.cover_cover as f64 - 2.0 * value * self.cover_region as f64
            + value * value * self.region_region as f64;
        Some(Share {
            value,
            error: squares.max(0.0).sqrt() / points,
        })
    }
}

/// Counts of all regions.
#[derive(Clone, Default)]
struct Tallies {
    solid_union: Tally,
    interior_union: Tally,
    interior_generating: Tally,
    layers: [Tally; LAYERS],
    slabs: [Tally; SLABS],
}

impl Tallies {
    fn merge(mut self, other: &Self) -> Self {
        self.solid_union.merge(&other.solid_union);
        self.interior_union.merge(&other.interior_union);
        self.interior_generating.merge(&other.interior_generating);
        self.layers
            .iter_mut()
            .zip(&other.layers)
            .for_each(|(a, b)| a.merge(b));
        self.slabs
            .iter_mut()
            .zip(&other.slabs)
            .for_each(|(a, b)| a.merge(b));
        self
    }
}

/// Cells of the bounding box, x fastest.
struct Cells {
    count: [usize; 3],
    step: [f64; 3],
}

impl Cells {
    fn new(extent: [f64; 3], shape_volume: f64) -> Self {
        let box_volume: f64 = extent.iter().product();
        let wanted = (0.5 * POINTS_IN_SOLID * box_volume / shape_volume).clamp(1.0, MOST_CELLS);
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

/// Samples the packing. `interior_depth` and `mean_diameter` in local units.
pub(super) fn sample(packing: &Packing, interior_depth: f64, mean_diameter: f64) -> Sampled {
    let cells = Cells::new(packing.extent, packing.shape_volume);
    let covered = cover(packing, &cells);
    let layer = mean_diameter / LAYERS_PER_DIAMETER;
    let longest = (0..3).fold(0, |best, k| {
        if packing.extent[k] > packing.extent[best] {
            k
        } else {
            best
        }
    });
    let slab = packing.extent[longest] / SLABS as f64;
    let cap = (layer * LAYERS as f64).max(interior_depth * (1.0 + 1e-12));

    let rows: Vec<usize> = (0..cells.count[1] * cells.count[2]).collect();
    let parts: Vec<Tallies> = rows
        .par_chunks(ROWS_PER_TASK)
        .map(|rows| {
            let mut tallies = Tallies::default();
            let mut probe = Probe::new(packing, cap);
            for row in rows {
                let (y, z) = (row % cells.count[1], row / cells.count[1]);
                for x in 0..cells.count[0] {
                    let bits = covered[cells.index(x, y, z)].load(Relaxed);
                    let points = cells.points([x, y, z]);
                    let union = UNION.map(|bit| bits & bit != 0);
                    let generating = GENERATING.map(|bit| bits & bit != 0);
                    let depths = points.map(|point| probe.depth(point));
                    // A covered point is inside, whatever rounding says at the wall.
                    let solid = [0, 1].map(|i| union[i] || depths[i] > 0.0);
                    if !(solid[0] || solid[1]) {
                        continue;
                    }
                    let interior = depths.map(|d| d > interior_depth);
                    tallies.solid_union.add(solid, union);
                    tallies.interior_union.add(interior, union);
                    tallies.interior_generating.add(interior, generating);
                    let layers = [0, 1].map(|i| {
                        if solid[i] {
                            (depths[i] / layer) as usize
                        } else {
                            LAYERS
                        }
                    });
                    let slabs = [0, 1].map(|i| {
                        if interior[i] {
                            ((points[i][longest] / slab) as usize).min(SLABS - 1)
                        } else {
                            SLABS
                        }
                    });
                    add_to_each(&mut tallies.layers, layers, generating);
                    add_to_each(&mut tallies.slabs, slabs, generating);
                }
            }
            tallies
        })
        .collect();
    let tallies = parts.iter().fold(Tallies::default(), Tallies::merge);

    let unit = packing.unit_m;
    let profile = |tallies: &[Tally], thickness: f64| {
        let place = |i: usize| i as f64 * thickness * unit;
        let layer = |(i, t): (usize, &Tally)| Layer {
            from_m: place(i),
            to_m: place(i + 1),
            density: t.share(),
        };
        tallies.iter().enumerate().map(layer).collect()
    };
    Sampled {
        union_density: tallies.solid_union.share().unwrap_or(Share {
            value: 0.0,
            error: 1.0,
        }),
        interior_union_density: tallies.interior_union.share(),
        interior_generating_density: tallies.interior_generating.share(),
        wall_profile: profile(&tallies.layers, layer),
        slab_profile: profile(&tallies.slabs, slab),
    }
}

/// Adds a cell to the regions its two points are in; an index past the end is in none.
fn add_to_each(tallies: &mut [Tally], indices: [usize; 2], covered: [bool; 2]) {
    for i in [0, 1] {
        if indices[i] >= tallies.len() || (i == 1 && indices[1] == indices[0]) {
            continue;
        }
        let region = indices.map(|other| other == indices[i]);
        tallies[indices[i]].add(region, covered);
    }
}
