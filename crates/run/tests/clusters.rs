//! Clusters compared with a search from scratch; fragments compared with the total.

mod breaking;
mod fragments;

use std::sync::Arc;

use crate::bars::ELASTIC;
use dem_engine::state::bonds::Bonds;
use dem_physics::bond::stiffness::Stiffness;

/// Bonds between these particles.
pub(crate) fn bonds(pairs: impl IntoIterator<Item = [u32; 2]>) -> Bonds {
    let mut sorted: Vec<[u32; 2]> = pairs
        .into_iter()
        .filter(|[a, b]| a != b)
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    sorted.sort_unstable();
    sorted.dedup();
    let mut bonds = Bonds {
        rules: Arc::new([ELASTIC]),
        ..Bonds::default()
    };
    let stiffness = Stiffness {
        normal: 1.0,
        shear: 1.0,
        torsion: 1.0,
        bending: 1.0,
        levers_m: [0.5; 2],
    };
    for ends in sorted {
        bonds.push(ends, [1.0, 0.0, 0.0], 0.1, &stiffness, 0);
    }
    bonds
}

/// A chain of this many particles.
pub(crate) fn chain(first: u32, count: u32) -> impl Iterator<Item = [u32; 2]> {
    (first..first + count - 1).map(|p| [p, p + 1])
}

/// The bond between two particles.
pub(crate) fn between(bonds: &Bonds, a: u32, b: u32) -> u32 {
    bonds.ends.iter().position(|ends| *ends == [a, b]).unwrap() as u32
}
