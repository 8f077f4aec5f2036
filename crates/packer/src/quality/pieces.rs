//! Pieces: sets of particles connected by bonds.

use dem_io::disjoint::DisjointSets;
use serde::{Deserialize, Serialize};

/// Pieces of a body: particles connected by bonds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pieces {
    /// Number of pieces, single particles included.
    pub count: usize,
    /// Fraction of the particles that are in the largest piece.
    pub largest_fraction: f64,
    /// Number of particles in all other pieces.
    pub outside_largest: usize,
    /// Number of particles without a bond.
    pub without_bond: usize,
    /// Number of particles with a single bond.
    pub with_one_bond: usize,
}

/// The pieces of this number of particles.
pub(super) fn find(particles: usize, bonds: &[[u32; 2]]) -> Pieces {
    let mut sets = DisjointSets::new(particles);
    let mut bonds_of = vec![0_u32; particles];
    for [a, b] in bonds {
        sets.join(*a, *b);
        bonds_of[*a as usize] += 1;
        bonds_of[*b as usize] += 1;
    }
    let mut count = 0;
    let mut largest = 0;
    for a in 0..particles as u32 {
        if sets.root(a) == a {
            count += 1;
            largest = largest.max(sets.size(a) as usize);
        }
    }
    Pieces {
        count,
        largest_fraction: largest as f64 / particles.max(1) as f64,
        outside_largest: particles - largest,
        without_bond: bonds_of.iter().filter(|n| **n == 0).count(),
        with_one_bond: bonds_of.iter().filter(|n| **n == 1).count(),
    }
}
