//! The thinnest part of a body, as its bonds and the depths of its particles show it.
//!
//! Particles are taken from the deepest to the shallowest, bonds joining those taken. Where two sets that are both more
//! than crumbs meet, there is a neck between them, as deep as the shallower end of the joining bond; where a piece ends up
//! alone, its deepest particle is its thickness. The thinnest part is the smallest of all these, twice the depth. It is
//! right to about one diameter, never too large, and does not see a fin that grows out of a thick part.

use super::pieces::Sets;
use serde::{Deserialize, Serialize};

/// Thicker than twice this is not measured.
pub(super) const CAP_IN_MEAN_DIAMETERS: f64 = 10.0;
/// Steps of depth up to the cap.
const LEVELS: usize = 400;
/// A set of fewer particles, or of a smaller share of them, is a crumb.
const FEWEST_PARTICLES: usize = 20;
const SMALLEST_PART: f64 = 0.01;

/// The thinnest part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Thinnest {
    /// Its thickness, m: the diameter of the largest ball that passes through.
    pub thickness_m: f64,
    /// The same in mean diameters.
    pub particles_across: f64,
    /// Thicker than could be measured: the two numbers are lower limits.
    pub at_least: bool,
}

/// The thinnest part from the particles' depths (up to the cap) and bonds. None without particles.
pub(super) fn thinnest(
    depths: &[f64],
    bonds: &[[u32; 2]],
    mean_diameter: f64,
    unit_m: f64,
) -> Option<Thinnest> {
    let deepest = depths.iter().copied().reduce(f64::max)?;
    let cap = CAP_IN_MEAN_DIAMETERS * mean_diameter;
    let top = deepest.min(cap);
    let level = |depth: f64| {
        if top > 0.0 {
            ((depth / top).min(1.0) * LEVELS as f64) as usize
        } else {
            0
        }
    };
    let levels: Vec<u16> = depths.iter().map(|d| level(*d) as u16).collect();
    let crumb = FEWEST_PARTICLES.max((SMALLEST_PART * depths.len() as f64) as usize) as u32;

    let mut sets = Sets::new(depths.len());
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
    let thickness = 2.0 * top * thinnest as f64 / LEVELS as f64;
    Some(Thinnest {
        thickness_m: thickness * unit_m,
        particles_across: thickness / mean_diameter,
        at_least: deepest >= cap && thinnest == LEVELS,
    })
}

/// Indices of the bonds, ordered by the level of the shallower end and then of the deeper one, the deepest first: a
/// particle joins what lies deeper before it joins its like.
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
