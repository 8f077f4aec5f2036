//! The data of bonds that their forces depend on, in blocks.

use serde::{Deserialize, Serialize};

/// Bonds in a block.
pub const BLOCK: usize = 8;

/// One number for each bond of a block.
pub type Column = [f64; BLOCK];

/// Consecutive bonds: the data that their forces depend on, number by number, so that the loop over
/// bonds reads complete vectors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[repr(align(64))]
pub struct BondBlock {
    /// Unit vectors from the first to the second end at the start, x, y, z; of a bond that has
    /// yielded, its stress-free direction.
    pub direction: [Column; 3],
    /// Stress-free distances of the contact point from the two ends, m: the initial ones until a
    /// bond yields.
    pub levers_m: [Column; 2],
    /// Along the bond, N/m. A broken bond has no stiffness.
    pub normal: Column,
    /// Across the bond, N/m.
    pub shear: Column,
    /// Bond radii, m. They give the bending stiffness, which is the normal stiffness times r^2/4 in
    /// every model that has one.
    pub radii_m: Column,
}

impl BondBlock {
    /// A block without bonds.
    pub const EMPTY: Self = Self {
        direction: [[0.0; BLOCK]; 3],
        levers_m: [[0.0; BLOCK]; 2],
        normal: [0.0; BLOCK],
        shear: [0.0; BLOCK],
        radii_m: [1.0; BLOCK],
    };
}
