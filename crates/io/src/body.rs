//! A body: spheres, the bonds between them, and what is known of both.

use serde::{Deserialize, Serialize};

/// What is known of how a body came about. Every field is optional: a body may come from anywhere.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// Program and version that made it.
    pub program: Option<String>,
    /// File that the shape came from.
    pub source: Option<String>,
    /// Hash of that file's bytes (FNV-1a, 64 bit).
    pub source_hash: Option<u64>,
    /// Volume of the shape, m3.
    pub shape_volume_m3: Option<f64>,
    /// Density of the particles' material, kg/m3.
    pub particle_density_kg_m3: Option<f64>,
    /// Overlap o of the packing: spheres touch at r/(1 + o).
    pub overlap: Option<f64>,
    /// Bonds join pairs closer than this times the sum of their radii.
    pub bonding_radius: Option<f64>,
    /// Seed of the random numbers.
    pub seed: Option<u64>,
}

/// Spheres joined by bonds. SI units.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Body {
    /// Centres, m. One per particle.
    pub positions: Vec<[f64; 3]>,
    /// Radii, m. One per particle.
    pub radii: Vec<f64>,
    /// The two particles of each bond, the smaller index first. One per bond.
    pub bonds: Vec<[u32; 2]>,
    /// Bond radii, m. One per bond.
    pub bond_radii: Vec<f64>,
    /// Initial bond lengths, m. One per bond.
    pub bond_lengths: Vec<f64>,
    /// Where it came from.
    pub about: About,
}
