//! The objects of a measure.

use super::Probe;

impl Probe {
    /// The walls among its two objects, by number.
    pub fn walls(&self) -> [Option<usize>; 2] {
        self.walls
    }

    /// The particles of its first object, ascending, if that is not a wall.
    pub fn particles(&self) -> &[u32] {
        &self.members.particles
    }
}
