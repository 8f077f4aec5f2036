//! What damping of bonds remembers of earlier steps.

use serde::{Deserialize, Serialize};

use super::particles::{Motion, Wrench};

/// What damping of bonds in one stage remembers where a running mean is not enough: one entry for
/// each free particle. Those of particles that sleep are not read. Empty: nothing, and the next
/// step is to begin it.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct DampingMemory {
    /// Velocities and spins that damping acted on, one, two and three steps before.
    pub motions: [Vec<Motion>; 3],
    /// Damping forces two and three steps before.
    pub forces: [Vec<Wrench>; 2],
}

impl DampingMemory {
    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.forces[0].is_empty()
    }

    /// Forgets all, as when particles get other numbers, or wake.
    pub fn clear(&mut self) {
        self.motions.iter_mut().for_each(Vec::clear);
        self.forces.iter_mut().for_each(Vec::clear);
    }

    /// Whether it can be that of so many free particles.
    pub(super) fn fits(&self, free: usize) -> bool {
        let lengths = (self.motions.iter().map(Vec::len)).chain(self.forces.iter().map(Vec::len));
        let wanted = if self.is_empty() { 0 } else { free };
        lengths.into_iter().all(|length| length == wanted)
    }

    /// Bytes of its arrays.
    pub(crate) fn bytes(&self) -> usize {
        let motions = self.motions.iter().map(|motions| size_of_val(&motions[..]));
        let forces = self.forces.iter().map(|forces| size_of_val(&forces[..]));
        motions.chain(forces).sum()
    }
}
