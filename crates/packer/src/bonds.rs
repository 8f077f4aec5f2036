//! Bonds: the pairs of spheres that are joined.
//!
//! A pair is joined when the distance of its centres is at most `bond_range * (R_a + R_b)`, true
//! radii (Platzer 2022, section 4.1: 1.0 and 1.1), and no surface lies between them: two fingers of
//! one shape stay separate.

use crate::spheres::Spheres;
use dem_io::{Diagnostic, Result};
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;

/// True if the straight line between the centres of two spheres, given by their indices, crosses
/// the surface.
pub type CrossesSurface<'a> = &'a (dyn Fn(u32, u32) -> bool + Sync);

/// Beyond this bond range a bond would pass through other spheres.
pub(crate) const LARGEST_BOND_RANGE: f64 = 2.0;
/// Bonds per particle of a well bonded body (Platzer 2022: 377,052 bonds of 77,487 spheres, 4.87).
pub(crate) const WELL_BONDED: f64 = 5.0;
/// Which spheres are bonded, and how thick the bonds are.
#[derive(Debug, Clone, PartialEq)]
pub struct BondSettings {
    /// Bonds join pairs with distance <= this * (R_a + R_b), unless `per_particle` is given.
    pub range: f64,
    /// Target number of bonds per particle, for which the bond range is chosen.
    pub per_particle: Option<f64>,
    /// Bond radius / smaller particle radius.
    pub radius_factor: f64,
}

impl Default for BondSettings {
    /// The program's defaults: bonds between spheres up to 1.1 times the sum of their radii apart,
    /// as thick as the smaller of the two.
    fn default() -> Self {
        Self {
            range: 1.1,
            per_particle: None,
            radius_factor: 1.0,
        }
    }
}

impl BondSettings {
    /// The bond range that is given, or that gives the wanted number of bonds.
    pub(crate) fn range_for(&self, spheres: &Spheres, crosses: CrossesSurface) -> Result<f64> {
        match self.per_particle {
            Some(wanted) => bond_range_for(spheres, wanted, crosses),
            None => Ok(self.range),
        }
    }
}

/// Number of spheres whose neighbours are counted to suggest a bond range: enough to know the
/// number of bonds to 1 %.
const SPHERES_TO_ADVISE: usize = 5000;
/// Number of spheres that one task searches around. Fixed, so that the order of results does not
/// depend on the number of threads.
const CHUNK: usize = 4096;

/// The bonds of a packing, the smaller index first, sorted. `crosses_surface` is only called for
/// pairs farther apart than the sum of their radii: a closer pair has its line of centres inside
/// its two balls, which lie in the solid. `bond_range`: above 0 and at most 2.
pub fn find_bonds(
    spheres: &Spheres,
    bond_range: f64,
    crosses_surface: CrossesSurface,
) -> Result<Vec<[u32; 2]>> {
    if !(bond_range > 0.0 && bond_range <= LARGEST_BOND_RANGE) {
        return Err(Diagnostic::input(
            "--bond-range",
            format!("{bond_range} is not above 0 and at most {LARGEST_BOND_RANGE}"),
            "give the largest distance of two bonded spheres as a multiple of the sum of their radii, such as 1.1",
        ));
    }
    let parts = search(spheres, bond_range, |a, b, distance| {
        is_joined(spheres, a, b, distance, crosses_surface).then(|| [a.min(b), a.max(b)])
    })?;
    Ok(sorted(parts, spheres.radii.len()))
}

/// All pairs with centres at most `ratio * (R_a + R_b)` apart, the smaller index first, sorted.
pub fn close_pairs(spheres: &Spheres, ratio: f64) -> Result<Vec<[u32; 2]>> {
    let parts = search(spheres, ratio, |a, b, _| Some([a.min(b), a.max(b)]))?;
    Ok(sorted(parts, spheres.radii.len()))
}

/// The bond range that gives `wanted` bonds per particle (bonds divided by particles) as closely as
/// a whole number of bonds allows: half-way between the last pair that is joined and the first that
/// is not. Refuses what a bond range of 2 does not reach.
pub fn bond_range_for(
    spheres: &Spheres,
    wanted: f64,
    crosses_surface: CrossesSurface,
) -> Result<f64> {
    const PLACE: &str = "--bonds-per-particle";
    let count = spheres.radii.len();
    if !(wanted > 0.0 && wanted.is_finite()) {
        return Err(Diagnostic::input(
            PLACE,
            format!("{wanted} is not a positive number"),
            "4 to 6 is usual",
        ));
    }
    let bonds = ((wanted * count as f64).round() as usize).max(1);
    let mut limit = 1.05_f64;
    loop {
        let parts = search(spheres, limit, |a, b, distance| {
            let sum = spheres.radii[a as usize] + spheres.radii[b as usize];
            is_joined(spheres, a, b, distance, crosses_surface).then(|| distance / sum)
        })?;
        let mut ratios = parts.concat();
        if ratios.len() >= bonds {
            let (_, last, rest) = ratios.select_nth_unstable_by(bonds - 1, f64::total_cmp);
            let next = rest.iter().copied().fold(limit, f64::min);
            return Ok(0.5 * (*last + next));
        }
        if limit >= LARGEST_BOND_RANGE {
            return Err(Diagnostic::input(
                PLACE,
                format!(
                    "{wanted} bonds per particle cannot be reached: {} even with the largest bond range of {LARGEST_BOND_RANGE}",
                    dem_io::units::significant(ratios.len() as f64 / count.max(1) as f64, 3)
                ),
                "ask for fewer",
            ));
        }
        limit = (limit * 1.2).min(LARGEST_BOND_RANGE);
    }
}

/// The bond range to suggest when a packing has too few bonds: it gives 5 bonds per particle,
/// rounded up to two decimals. None if no bond range does. In large packings only the neighbours of
/// a sample of spheres are counted.
pub fn suggested_bond_range(spheres: &Spheres, crosses_surface: CrossesSurface) -> Option<f64> {
    let radii = &spheres.radii;
    let stride = radii.len().div_ceil(SPHERES_TO_ADVISE).max(1);
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let tree = tree_of(spheres).ok()?;
    let around: Vec<u32> = (0..radii.len() as u32).step_by(stride).collect();
    // Every bond has two ends.
    let ends = ((2.0 * WELL_BONDED * around.len() as f64).round() as usize).max(1);
    let mut limit = 1.25_f64;
    loop {
        let ratios_of = |a: &u32| {
            let radius_a = radii[*a as usize];
            let mut ratios = Vec::new();
            let reach = limit * (radius_a + largest);
            let neighbours = tree
                .query(&spheres.positions[*a as usize])
                .within::<SquaredEuclidean<f64>>(reach * reach)
                .unsorted();
            neighbours.visit(|neighbour| {
                let (b, distance) = (neighbour.item, neighbour.distance.sqrt());
                let ratio = distance / (radius_a + radii[b as usize]);
                if b != *a && ratio <= limit && is_joined(spheres, *a, b, distance, crosses_surface)
                {
                    ratios.push(ratio);
                }
            });
            ratios
        };
        let mut ratios: Vec<f64> = around.par_iter().flat_map_iter(ratios_of).collect();
        if ratios.len() >= ends {
            let (_, last, _) = ratios.select_nth_unstable_by(ends - 1, f64::total_cmp);
            return Some((*last * 100.0).ceil() / 100.0);
        }
        if limit >= LARGEST_BOND_RANGE {
            return None;
        }
        limit = (limit * 1.2).min(LARGEST_BOND_RANGE);
    }
}

/// Distances between the centres of bonded spheres, which are the initial lengths of the bonds,
/// local units. One per bond.
pub fn bond_lengths(spheres: &Spheres, bonds: &[[u32; 2]]) -> Vec<f64> {
    bonds
        .par_iter()
        .with_min_len(CHUNK)
        .map(|[a, b]| centre_distance(spheres, *a, *b))
        .collect()
}

/// Radii of bonds: `factor` times the smaller of the two spheres' radii, local units. One per bond.
pub fn bond_radii(spheres: &Spheres, bonds: &[[u32; 2]], factor: f64) -> Vec<f64> {
    let radii = &spheres.radii;
    bonds
        .par_iter()
        .with_min_len(CHUNK)
        .map(|[a, b]| factor * radii[*a as usize].min(radii[*b as usize]))
        .collect()
}

pub(crate) fn centre_distance(spheres: &Spheres, a: u32, b: u32) -> f64 {
    let (p, q) = (spheres.positions[a as usize], spheres.positions[b as usize]);
    let (x, y, z) = (p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    (x * x + y * y + z * z).sqrt()
}

/// True if no surface lies between two spheres. A point of the line of centres at distance t from a
/// is in ball a if t <= R_a, and in ball b if distance - t <= R_b; if it were in neither,
/// distance > R_a + R_b. The balls lie inside the solid, so only pairs farther apart than R_a + R_b
/// can have surface between them.
fn is_joined(
    spheres: &Spheres,
    a: u32,
    b: u32,
    distance: f64,
    crosses_surface: CrossesSurface,
) -> bool {
    distance <= spheres.radii[a as usize] + spheres.radii[b as usize] || !crosses_surface(a, b)
}

/// `keep(a, b, distance)` for every pair with distance <= ratio (R_a + R_b), where a is the larger
/// sphere. Each pair occurs once. The pairs come in chunks whose order depends only on the spheres.
///
/// Each sphere searches only for its smaller neighbours, all of them within 2 ratio R_a. For
/// spheres that do not overlap much, at most about 8 ratio^3 of them have a given point within that
/// distance, whatever their sizes, so no distribution is slow.
fn search<T: Send>(
    spheres: &Spheres,
    ratio: f64,
    keep: impl Fn(u32, u32, f64) -> Option<T> + Sync,
) -> Result<Vec<Vec<T>>> {
    let radii = &spheres.radii;
    if radii.is_empty() {
        return Ok(Vec::new());
    }
    let tree = tree_of(spheres)?;
    // In the order of the tree's leaves, so that the data of one sphere are still in the cache for
    // the next.
    let order: Vec<u32> = tree.iter().map(|(item, _)| item).collect();
    let search_around = |chunk: &[u32]| {
        let mut found = Vec::with_capacity(6 * chunk.len());
        for &a in chunk {
            let radius_a = radii[a as usize];
            // Slightly more, so that rounding in the tree drops no pair; the exact test follows.
            let reach = 2.0 * ratio * radius_a * (1.0 + 1e-9);
            let neighbours = tree
                .query(&spheres.positions[a as usize])
                .within::<SquaredEuclidean<f64>>(reach * reach)
                .unsorted();
            neighbours.visit(|neighbour| {
                let b = neighbour.item;
                let radius_b = radii[b as usize];
                if radius_b < radius_a || (radius_b == radius_a && b > a) {
                    let distance = neighbour.distance.sqrt();
                    if distance <= ratio * (radius_a + radius_b) {
                        found.extend(keep(a, b, distance));
                    }
                }
            });
        }
        found
    };
    Ok(order.par_chunks(CHUNK).map(search_around).collect())
}

fn tree_of(spheres: &Spheres) -> Result<ImmutableKdTree<f64, 3>> {
    ImmutableKdTree::new_from_slice(&spheres.positions).map_err(|e| {
        Diagnostic::failed(
            "",
            format!("no search tree over {} spheres: {e}", spheres.radii.len()),
            "",
        )
    })
}

/// The pairs, sorted: distributed by their first index (counting sort), then each sphere's few
/// pairs sorted by the second.
fn sorted(parts: Vec<Vec<[u32; 2]>>, spheres: usize) -> Vec<[u32; 2]> {
    let mut starts = vec![0_u32; spheres + 1];
    for [a, _] in parts.iter().flatten() {
        starts[*a as usize + 1] += 1;
    }
    let mut total = 0_usize;
    for start in &mut starts {
        total += *start as usize;
        *start = total as u32;
    }
    let mut pairs = vec![[0_u32; 2]; total];
    let mut next = starts;
    for part in parts {
        for pair in part {
            let slot = &mut next[pair[0] as usize];
            pairs[*slot as usize] = pair;
            *slot += 1;
        }
    }
    // Each slot now points to the end of its row.
    let mut begin = 0;
    for end in &next[..spheres] {
        pairs[begin..*end as usize].sort_unstable();
        begin = *end as usize;
    }
    pairs
}
