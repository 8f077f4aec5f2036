//! What the bonds hold together.

use serde::{Deserialize, Serialize};

/// Pieces of a body: particles joined by bonds.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pieces {
    /// How many, single particles included.
    pub count: usize,
    /// Fraction of the particles that are in the largest.
    pub largest_share: f64,
    /// Particles in all others.
    pub outside_largest: usize,
    /// Particles without a bond.
    pub without_bond: usize,
    /// Particles that hang on one bond.
    pub with_one_bond: usize,
}

/// Disjoint sets of particles with their sizes.
pub(super) struct Sets {
    parent: Vec<u32>,
    size: Vec<u32>,
}

impl Sets {
    pub(super) fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
            size: vec![1; count],
        }
    }

    /// The particle that stands for the set of `a`.
    pub(super) fn root(&mut self, mut a: u32) -> u32 {
        while self.parent[a as usize] != a {
            self.parent[a as usize] = self.parent[self.parent[a as usize] as usize];
            a = self.parent[a as usize];
        }
        a
    }

    /// Joins the sets of two particles; the sizes of the smaller and the larger before, or None if they were one already.
    pub(super) fn join(&mut self, a: u32, b: u32) -> Option<(u32, u32)> {
        let (a, b) = (self.root(a), self.root(b));
        if a == b {
            return None;
        }
        let (small, large) = if self.size(a) < self.size(b) {
            (a, b)
        } else {
            (b, a)
        };
        let sizes = (self.size(small), self.size(large));
        self.parent[small as usize] = large;
        self.size[large as usize] += sizes.0;
        Some(sizes)
    }

    /// Number of particles in the set that `root` stands for.
    pub(super) fn size(&self, root: u32) -> u32 {
        self.size[root as usize]
    }
}

/// The pieces of so many particles.
pub(super) fn find(particles: usize, bonds: &[[u32; 2]]) -> Pieces {
    let mut sets = Sets::new(particles);
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
        largest_share: largest as f64 / particles.max(1) as f64,
        outside_largest: particles - largest,
        without_bond: bonds_of.iter().filter(|n| **n == 0).count(),
        with_one_bond: bonds_of.iter().filter(|n| **n == 1).count(),
    }
}
