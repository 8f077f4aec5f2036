//! Densities by sampling: the fraction of the solid, of its interior and of its layers that the
//! spheres cover.
//!
//! The standard error comes from the differences of the two random points of a cell: for a region
//! with indicator r, cover c and fraction f = sum(c r)/sum(r), it is sqrt(sum over cells of ((c -
//! f) r at one - (c - f) r at the other)^2)/sum(r). Everything is counted in integers, so that the
//! order of counting does not matter.

use super::bonded_packing::BondedPacking;
use super::depth::DepthQuery;
use super::points::{Box3, Cells, over_pairs};
use serde::{Deserialize, Serialize};

/// Number of random points in a region, for a standard error of 0.001 at most. With many points per
/// sphere they are evenly spread through it, so that fewer are needed in total.
const POINTS_PER_SPHERE: f64 = 100.0;
const FEWEST_POINTS_IN_REGION: f64 = 100_000.0;
const MOST_POINTS_IN_REGION: f64 = 250_000.0;
const LAYERS: usize = 20;
const LAYERS_PER_DIAMETER: f64 = 4.0;
const SLABS: usize = 10;
/// Number of points below which a region has no meaningful density.
const FEWEST_POINTS: u64 = 100;

/// A fraction found by sampling.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fraction {
    /// The fraction, 0 to 1.
    pub value: f64,
    /// Its standard error.
    pub error: f64,
}

/// The density of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// Its beginning, m.
    pub from_m: f64,
    /// Its end, m.
    pub to_m: f64,
    /// Its density. None if hardly any point lies in it.
    pub density: Option<Fraction>,
}

/// Densities from the sampled points.
pub(super) struct Sampled {
    pub(super) union_density: Fraction,
    pub(super) interior_union_density: Option<Fraction>,
    pub(super) interior_generating_density: Option<Fraction>,
    pub(super) wall_profile: Vec<Layer>,
    pub(super) slab_profile: Vec<Layer>,
}

/// Counts of one region.
#[derive(Clone, Copy, Default)]
struct Tally {
    points: u64,
    covered: u64,
    /// Sums over cells of products of the differences of its two points, in cover (c) and in region
    /// (r).
    cover_cover: u64,
    cover_region: i64,
    region_region: u64,
}

impl Tally {
    /// Adds a cell: for each of its two points, true if it is in the region, and true if it is
    /// covered there.
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

    fn fraction(&self) -> Option<Fraction> {
        if self.points < FEWEST_POINTS {
            return None;
        }
        let points = self.points as f64;
        let value = self.covered as f64 / points;
        let squares = self.cover_cover as f64 - 2.0 * value * self.cover_region as f64
            + value * value * self.region_region as f64;
        Some(Fraction {
            value,
            error: squares.max(0.0).sqrt() / points,
        })
    }
}

/// Counts for the entire solid and for the layers from the wall.
#[derive(Clone)]
struct Whole {
    union: Tally,
    /// Number of points in the interior.
    interior: u64,
    /// Box around all cells that reach into the interior.
    interior_box: Box3,
    layers: [Tally; LAYERS],
}

impl Default for Whole {
    fn default() -> Self {
        Self {
            union: Tally::default(),
            interior: 0,
            interior_box: Box3::EMPTY,
            layers: Default::default(),
        }
    }
}

/// Counts for the interior.
#[derive(Clone, Default)]
struct Interior {
    union: Tally,
    generating: Tally,
    slabs: [Tally; SLABS],
}

/// Samples the packing. `interior_depth` and `mean_diameter` in local units.
pub(super) fn sample(packing: &BondedPacking, interior_depth: f64, mean_diameter: f64) -> Sampled {
    let layer = mean_diameter / LAYERS_PER_DIAMETER;
    let whole = whole(packing, interior_depth, layer);
    let longest = (0..3).fold(0, |best, k| {
        if packing.extent[k] > packing.extent[best] {
            k
        } else {
            best
        }
    });
    let slab = packing.extent[longest] / SLABS as f64;
    let interior = interior(packing, interior_depth, &whole, longest, slab);

    let unit = packing.unit_m;
    let profile = |tallies: &[Tally], thickness: f64| {
        let place = |i: usize| i as f64 * thickness * unit;
        let layer = |(i, t): (usize, &Tally)| Layer {
            from_m: place(i),
            to_m: place(i + 1),
            density: t.fraction(),
        };
        tallies.iter().enumerate().map(layer).collect()
    };
    Sampled {
        union_density: whole.union.fraction().unwrap_or(Fraction {
            value: 0.0,
            error: 1.0,
        }),
        interior_union_density: interior.union.fraction(),
        interior_generating_density: interior.generating.fraction(),
        wall_profile: profile(&whole.layers, layer),
        slab_profile: profile(&interior.slabs, slab),
    }
}

fn points_for(spheres: f64) -> f64 {
    (POINTS_PER_SPHERE * spheres).clamp(FEWEST_POINTS_IN_REGION, MOST_POINTS_IN_REGION)
}

fn whole(packing: &BondedPacking, interior_depth: f64, layer: f64) -> Whole {
    let within = Box3 {
        low: [0.0; 3],
        high: packing.extent,
    };
    let spheres = packing.spheres.radii.len() as f64;
    let cells = Cells::new(&within, packing.shape_volume, points_for(spheres));
    let diagonal = cells.step.iter().map(|s| s * s).sum::<f64>().sqrt();
    let question = DepthQuery {
        floor: 0.0,
        cap: interior_depth.max(layer * LAYERS as f64) * 1.01,
        layer,
        limit: interior_depth,
    };
    let parts = over_pairs(packing, &cells, question, |counts: &mut Whole, pair| {
        // A covered point is inside, despite rounding at the wall.
        let solid = [0, 1].map(|i| pair.in_union[i] || pair.depths[i] > 0.0);
        counts.union.add(solid, pair.in_union);
        counts.interior += pair.depths.iter().filter(|d| **d > interior_depth).count() as u64;
        // Between two points of a cell, the depth changes by no more than their distance.
        if pair.depths[0].min(pair.depths[1]) + diagonal > interior_depth {
            counts.interior_box.add(&Box3 {
                low: pair.corner,
                high: [0, 1, 2].map(|k| pair.corner[k] + cells.step[k]),
            });
        }
        let layers = [0, 1].map(|i| {
            if solid[i] {
                (pair.depths[i] / layer) as usize
            } else {
                LAYERS
            }
        });
        add_to_each(&mut counts.layers, layers, pair.in_generating);
    });
    parts.iter().fold(Whole::default(), |mut sum, part| {
        sum.union.merge(&part.union);
        sum.interior += part.interior;
        sum.interior_box.add(&part.interior_box);
        sum.layers
            .iter_mut()
            .zip(&part.layers)
            .for_each(|(a, b)| a.merge(b));
        sum
    })
}

/// Slabs of thickness `slab` along the axis `longest`.
fn interior(
    packing: &BondedPacking,
    depth: f64,
    whole: &Whole,
    longest: usize,
    slab: f64,
) -> Interior {
    if whole.interior == 0 {
        return Interior::default();
    }
    let fraction = whole.interior as f64 / whole.union.points as f64;
    let spheres = packing.spheres.radii.len() as f64;
    let cells = Cells::new(
        &whole.interior_box,
        fraction * packing.shape_volume,
        points_for(fraction * spheres),
    );
    let question = DepthQuery {
        floor: depth,
        cap: depth * (1.0 + 1e-12),
        layer: f64::INFINITY,
        limit: depth,
    };
    let parts = over_pairs(packing, &cells, question, |counts: &mut Interior, pair| {
        let inside = pair.depths.map(|d| d > depth);
        counts.union.add(inside, pair.in_union);
        counts.generating.add(inside, pair.in_generating);
        let slabs = [0, 1].map(|i| {
            if inside[i] {
                ((pair.points[i][longest] / slab) as usize).min(SLABS - 1)
            } else {
                SLABS
            }
        });
        add_to_each(&mut counts.slabs, slabs, pair.in_generating);
    });
    parts.iter().fold(Interior::default(), |mut sum, part| {
        sum.union.merge(&part.union);
        sum.generating.merge(&part.generating);
        sum.slabs
            .iter_mut()
            .zip(&part.slabs)
            .for_each(|(a, b)| a.merge(b));
        sum
    })
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
