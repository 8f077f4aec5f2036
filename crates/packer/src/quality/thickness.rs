//! The thinnest part of a body, from its bonds and the depths of its particles.
//!
//! Particles are taken from the deepest to the shallowest, bonds joining those taken. Where two
//! sets that are both larger than crumbs meet, there is a neck between them, as deep as the
//! shallower end of the joining bond; where a piece ends up alone, its deepest particle is its
//! thickness. The thinnest part is the smallest of all these, twice the depth. Centres of particles
//! seldom lie exactly in the middle, so this estimate is too small by up to two diameters. If there
//! are few particles across, the same is therefore done with the points of a lattice that lie
//! deeper than the smallest particle needs, each joined to its six neighbours, and the larger
//! result is used. Every path through the solid passes within half a cell diagonal of lattice
//! points, so the result is too small by at most a diagonal: 0.43 mean diameters up to some
//! [`MOST_POINTS`] / 64 particles, more in larger bodies. It does not see a fin that grows out of a
//! thick part.

use super::bonded_packing::{BondedPacking, CAP_IN_MEAN_DIAMETERS};
use super::depth::{DepthProbe, DepthQuery};
use dem_io::body::few_across;
use dem_io::disjoint::DisjointSets;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Steps of depth up to the cap.
const LEVELS: usize = 400;
/// Mean diameters across, by the particles, above which the lattice is left out: two more or less
/// make no difference.
const MANY_ACROSS: f64 = 15.0;
/// Edge of a lattice cell in mean diameters: a quarter of the relevant difference of one particle
/// across.
const FINEST_EDGE: f64 = 0.25;
/// Approximate number of lattice points inside the solid, and largest number in the entire box, for
/// regions that fill little of it.
const MOST_POINTS: f64 = 1.5e5;
const MOST_POINTS_IN_BOX: f64 = 1e6;
/// Smallest number and fraction of particles in a set that is not a crumb.
const FEWEST_PARTICLES: usize = 20;
const SMALLEST_PART: f64 = 0.01;

/// The thinnest part of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Thinnest {
    /// Its thickness, m: the diameter of the largest ball that passes through.
    pub thickness_m: f64,
    /// The same in mean diameters.
    pub particles_across: f64,
    /// True if it is thicker than could be measured: the two numbers are lower limits.
    pub at_least: bool,
}

impl Thinnest {
    /// A sentence on few particles across. None: there are enough.
    pub fn few(&self) -> Option<String> {
        few_across(self.particles_across, "the thinnest part", self.thickness_m)
    }
}

/// The thinnest part, as described above. None without particles.
pub(super) fn thinnest(
    packing: &BondedPacking,
    depths: &[f64],
    mean_diameter: f64,
) -> Option<Thinnest> {
    let cap = CAP_IN_MEAN_DIAMETERS * mean_diameter;
    let by_particles = neck(depths, packing.bonds, cap, FEWEST_PARTICLES)?;
    let are_many = by_particles > 0.5 * MANY_ACROSS * mean_diameter;
    let (points, pairs) = if are_many {
        (Vec::new(), Vec::new())
    } else {
        lattice(packing, mean_diameter, cap)
    };
    // The number of points that fills as much of the solid as that many particles.
    let fewest = FEWEST_PARTICLES * points.len() / depths.len();
    let by_points = neck(&points, &pairs, cap, fewest).unwrap_or(0.0);
    let depth = by_particles.max(by_points);
    Some(Thinnest {
        thickness_m: 2.0 * depth * packing.unit_m,
        particles_across: 2.0 * depth / mean_diameter,
        at_least: depth >= cap,
    })
}

/// Depths of the lattice points that lie deeper than the smallest radius, and pairs of neighbours.
/// One point is in the middle of the box, so that the middle of a symmetric shape is not missed.
fn lattice(packing: &BondedPacking, mean_diameter: f64, cap: f64) -> (Vec<f64>, Vec<[u32; 2]>) {
    let box_volume: f64 = packing.extent.iter().product();
    let edge = (FINEST_EDGE * mean_diameter)
        .max((packing.shape_volume / MOST_POINTS).cbrt())
        .max((box_volume / MOST_POINTS_IN_BOX).cbrt());
    let each_side = packing.extent.map(|e| (0.5 * e / edge) as usize);
    let [nx, ny, nz] = each_side.map(|n| 2 * n + 1);
    let smallest = (packing.spheres.radii.iter().copied()).fold(f64::INFINITY, f64::min);
    let to_a_level = DepthQuery {
        floor: smallest * (1.0 - 1e-9),
        cap,
        layer: cap / LEVELS as f64,
        limit: 0.0,
    };
    let all: Vec<f64> =
        (0..ny * nz)
            .into_par_iter()
            .flat_map_iter(|row| {
                let mut probe = DepthProbe::new(packing, to_a_level);
                (0..nx).map(move |x| {
                    let at = [x, row % ny, row / ny];
                    probe.depth([0, 1, 2].map(|k| {
                        0.5 * packing.extent[k] + (at[k] as f64 - each_side[k] as f64) * edge
                    }))
                })
            })
            .collect();
    let (mut points, mut pairs) = (Vec::new(), Vec::new());
    let mut number = vec![u32::MAX; all.len()];
    for (at, depth) in all.into_iter().enumerate() {
        if depth <= 0.0 {
            continue;
        }
        let new = points.len() as u32;
        number[at] = new;
        points.push(depth);
        for (stride, is_first) in [
            (1, at % nx == 0),
            (nx, at / nx % ny == 0),
            (nx * ny, at < nx * ny),
        ] {
            if !is_first && number[at - stride] != u32::MAX {
                pairs.push([number[at - stride], new]);
            }
        }
    }
    (points, pairs)
}

/// Depth of the thinnest part of the set connected by `bonds`, at most `cap`. None if there is
/// nothing.
fn neck(depths: &[f64], bonds: &[[u32; 2]], cap: f64, fewest: usize) -> Option<f64> {
    let deepest = depths.iter().copied().reduce(f64::max)?;
    let top = deepest.min(cap);
    let level = |depth: f64| {
        if top > 0.0 {
            ((depth / top).min(1.0) * LEVELS as f64) as usize
        } else {
            0
        }
    };
    let levels: Vec<u16> = depths.iter().map(|d| level(*d) as u16).collect();
    let crumb = fewest.max((SMALLEST_PART * depths.len() as f64) as usize) as u32;

    let mut sets = DisjointSets::new(depths.len());
    let mut thinnest = LEVELS;
    for bond in deepest_first(bonds, &levels) {
        let [a, b] = bonds[bond as usize];
        if let Some((smaller, _)) = sets.join(a, b)
            && smaller >= crumb
        {
            thinnest = usize::from(levels[a as usize].min(levels[b as usize]));
        }
    }
    let mut deepest_of_piece = vec![0_u16; depths.len()];
    for (a, level) in levels.iter().enumerate() {
        let deepest = &mut deepest_of_piece[sets.root(a as u32) as usize];
        *deepest = (*deepest).max(*level);
    }
    for (root, deepest) in deepest_of_piece.into_iter().enumerate() {
        if sets.root(root as u32) as usize == root && sets.size(root as u32) >= crumb {
            thinnest = thinnest.min(usize::from(deepest));
        }
    }
    Some(top * thinnest as f64 / LEVELS as f64)
}

/// Indices of the bonds, ordered by the level of the shallower end and then of the deeper one, the
/// deepest first: a particle joins deeper ones before those of its own level.
fn deepest_first(bonds: &[[u32; 2]], levels: &[u16]) -> Vec<u32> {
    let ends = |bond: u32| bonds[bond as usize].map(|i| levels[i as usize]);
    let any_order = (0..bonds.len() as u32).collect();
    let by_deeper_end = sorted_down(any_order, |bond| ends(bond)[0].max(ends(bond)[1]));
    sorted_down(by_deeper_end, |bond| ends(bond)[0].min(ends(bond)[1]))
}

/// Sorted by level, the highest first; equal ones keep their order (counting sort).
fn sorted_down(bonds: Vec<u32>, level_of: impl Fn(u32) -> u16) -> Vec<u32> {
    let place = |bond: u32| LEVELS - usize::from(level_of(bond));
    let mut next = [0_usize; LEVELS + 2];
    for bond in &bonds {
        next[place(*bond) + 1] += 1;
    }
    for i in 0..=LEVELS {
        next[i + 1] += next[i];
    }
    let mut sorted = vec![0_u32; bonds.len()];
    for bond in bonds {
        let slot = &mut next[place(bond)];
        sorted[*slot] = bond;
        *slot += 1;
    }
    sorted
}
