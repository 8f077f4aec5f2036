//! Files of an export, and what the way back needs.

use dem_engine::state::model::NamedBody;
use serde::{Deserialize, Serialize};

/// Names of the files of an export, in its folder.
pub(crate) const DATA: &str = "particles.data";
pub(crate) const INPUT: &str = "in.lammps";
pub(crate) const TYPES: &str = "bond-types.lammps";
pub(crate) const CLUMPS: &str = "clumps.txt";
pub(crate) const PAGE: &str = "README.md";
pub(crate) const MANIFEST: &str = "export.json";
/// Names of the files that LAMMPS writes there.
pub(crate) const FRAMES: &str = "frames.dump";
pub(crate) const BONDS: &str = "bonds.dump";
pub(crate) const BROKEN: &str = "broken.dump";

/// What the way back needs and LAMMPS does not keep.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Manifest {
    /// Program that wrote it.
    pub program: String,
    /// The scene.
    pub scene: String,
    /// Number of steps until the end, and the time of the end, s.
    pub steps: u64,
    pub end_s: f64,
    /// The bodies.
    pub bodies: Vec<NamedBody>,
    /// For each molecule, its body: number in `bodies`.
    pub body_of_molecule: Vec<u32>,
    /// For each molecule whether it is a rigid clump.
    pub is_clump: Vec<bool>,
    /// Bodies that come while LAMMPS runs, each with its own type of atoms.
    pub fed: Vec<FedBody>,
    /// Radius of the bonds of each type, m.
    pub bond_radii_m: Vec<f64>,
    /// Whether bonds can break.
    pub breaks: bool,
    /// Sieves of the size distribution, m. Empty: those that its fragments suggest.
    pub sieves_m: Vec<f64>,
}

/// A body that an inlet feeds.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct FedBody {
    /// Type of its atoms.
    pub atom_type: u64,
    /// Number in `bodies`.
    pub body: u32,
    /// Whether it is a rigid clump.
    pub is_clump: bool,
    /// Density of its spheres, with which they have the mass of the body together, kg/m3.
    pub density_kg_m3: f64,
}

impl Manifest {
    /// Number of rigid clumps of several particles, with these molecules of the particles.
    pub(crate) fn clumps(&self, molecules: &[u32]) -> usize {
        let mut sizes = vec![0_u32; self.is_clump.len()];
        for molecule in molecules {
            sizes[*molecule as usize - 1] += 1;
        }
        let clumps = self.is_clump.iter().zip(sizes);
        clumps
            .filter(|(is_clump, size)| **is_clump && *size > 1)
            .count()
    }
}
