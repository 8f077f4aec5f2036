//! Contacts, and the exact checks: no overlap in r_gen, no sphere outside the wall.

use super::bonded_packing::BondedPacking;
use crate::bonds::{centre_distance, close_pairs};
use dem_io::Result;
use serde::{Deserialize, Serialize};

/// Number of contacts below which a particle can move.
const CONTACTS_THAT_HOLD: u32 = 4;

/// Contacts of the spheres reduced to r_gen, and of the true ones with the wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Contacts {
    /// Largest gap that counts as a contact, as a fraction of the smaller radius.
    pub gap_limit: f64,
    /// Mean number of spheres that a sphere touches.
    pub per_particle: f64,
    /// Number of spheres that touch the wall.
    pub at_wall: usize,
    /// Fraction of the particles with fewer than 4 contacts; the wall counts as one.
    pub rattlers: f64,
    /// Largest overlap of two spheres in r_gen, as a fraction of the smaller r_gen. 0 if none
    /// overlap.
    pub largest_overlap: f64,
    /// Largest protrusion of a sphere from the wall, as a fraction of its radius. 0 if there is
    /// none, 1 if a centre is outside.
    pub largest_protrusion: f64,
}

/// Counts the contacts. `depths` are those of the centres below the wall, local units, one per
/// sphere.
pub(super) fn count(packing: &BondedPacking, depths: &[f64]) -> Result<Contacts> {
    let spheres = packing.spheres;
    let shrink = 1.0 / (1.0 + packing.overlap);
    let radii = &spheres.radii;
    let mut contacts_of = vec![0_u32; radii.len()];
    let mut contacts = 0_usize;
    let mut largest_overlap = 0.0_f64;
    // The smaller radius is at most half the sum, so no contact is farther than this.
    let reach = shrink * (1.0 + 0.5 * packing.gap_limit);
    let searched;
    let pairs = if packing.bond_range >= reach {
        packing.bonds
    } else {
        searched = close_pairs(spheres, reach)?;
        &searched
    };
    for &[a, b] in pairs {
        let (r, s) = (radii[a as usize] * shrink, radii[b as usize] * shrink);
        let gap = (centre_distance(spheres, a, b) - (r + s)) / r.min(s);
        largest_overlap = largest_overlap.max(-gap);
        if gap <= packing.gap_limit {
            contacts += 1;
            contacts_of[a as usize] += 1;
            contacts_of[b as usize] += 1;
        }
    }
    let mut at_wall = 0;
    let mut largest_protrusion = 0.0_f64;
    for ((radius, depth), contacts) in radii.iter().zip(depths).zip(&mut contacts_of) {
        let gap = (depth - radius) / radius;
        largest_protrusion = largest_protrusion.max(-gap);
        if gap <= packing.gap_limit {
            at_wall += 1;
            *contacts += 1;
        }
    }
    let count = radii.len().max(1) as f64;
    Ok(Contacts {
        gap_limit: packing.gap_limit,
        per_particle: 2.0 * contacts as f64 / count,
        at_wall,
        rattlers: contacts_of
            .iter()
            .filter(|n| **n < CONTACTS_THAT_HOLD)
            .count() as f64
            / count,
        largest_overlap,
        largest_protrusion,
    })
}
