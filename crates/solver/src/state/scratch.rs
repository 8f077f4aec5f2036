//! What can be rebuilt from the other parts of a state, or holds for one step only.

use super::events::Events;
use super::particles::Wrench;
use super::partitions::Partition;
use crate::clock::StageClock;

/// What can be rebuilt from the other parts of a state, or holds for one step only. Contacts,
/// clusters and walls have such parts of their own.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    /// Number of partitions in which the work is divided, at most.
    pub threads: usize,
    /// Who works on which particles and bonds.
    pub partitions: Vec<Partition>,
    /// Damping forces of bonds. Empty: no bond is damped.
    pub bond_resistance: Vec<Wrench>,
    /// Damping forces on particles. Empty: none.
    pub particle_resistance: Vec<Wrench>,
    /// What happened in the last step.
    pub events: Events,
    /// Where the time goes.
    pub clock: StageClock,
}

impl Scratch {
    /// The lists of damping forces that are booked apart: of bonds and on particles; each with one
    /// for each particle, or empty.
    pub fn resistances(&self) -> [&[Wrench]; 2] {
        [&self.bond_resistance, &self.particle_resistance]
    }
}
