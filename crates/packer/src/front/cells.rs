//! Blocks of cells in eight colours: blocks of one colour are too far apart to disturb each other.

use super::assembly::FrontSphere;
use crate::grid::Lattice;
use crate::spheres::ReducedSphere;
use std::collections::BTreeMap;

/// Cells along the edge of a block.
const BLOCK: usize = 2;

/// Colour and number of the block that contains a sphere's centre.
pub(super) fn block_of(lattice: &Lattice, sphere: &ReducedSphere) -> (usize, usize) {
    let block = lattice
        .cell_of(sphere[0], sphere[1], sphere[2])
        .map(|c| c / BLOCK);
    let colour = block[0] % 2 + 2 * (block[1] % 2) + 4 * (block[2] % 2);
    (colour, lattice.index(block))
}

/// The spheres of the front by colour and block.
pub(super) fn by_colour(
    lattice: &Lattice,
    front: Vec<FrontSphere>,
) -> [BTreeMap<usize, Vec<FrontSphere>>; 8] {
    let mut colours: [BTreeMap<usize, Vec<FrontSphere>>; 8] = Default::default();
    for sphere in front {
        let (colour, block) = block_of(lattice, &sphere.0);
        colours[colour].entry(block).or_default().push(sphere);
    }
    colours
}
