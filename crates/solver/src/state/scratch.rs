//! Data that can be rebuilt from the other parts of a state, or are valid for one step only.

use super::events::Events;
use super::particles::Wrench;
use super::partitions::Partition;
use crate::clock::StageClock;

/// Data that can be rebuilt from the other parts of a state, or are valid for one step only.
/// Contacts, clusters and walls have such parts of their own.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    /// Largest number of partitions of the work.
    pub threads: usize,
    /// Division of particles and bonds among threads.
    pub partitions: Vec<Partition>,
    /// Damping forces of bonds. Empty: no bond is damped.
    pub bond_resistance: Vec<Wrench>,
    /// Damping forces on particles. Empty: none.
    pub particle_resistance: Vec<Wrench>,
    /// For each chunk of free particles the distance that the fastest of them moved in the last
    /// drift, m.
    pub chunks_moved_m: Vec<f64>,
    /// Damaged bonds that have reached their compressive strength.
    pub(crate) crushed: Vec<u32>,
    /// Contacts that triggers have read in this step.
    pub(crate) squeezing: usize,
    /// Events of the last step.
    pub events: Events,
    /// Time spent in each stage.
    pub clock: StageClock,
}

impl Scratch {
    /// The lists of damping forces that are recorded separately: of bonds and on particles; each
    /// with one for each particle, or empty.
    pub(crate) fn resistances(&self) -> [&[Wrench]; 2] {
        [&self.bond_resistance, &self.particle_resistance]
    }
}
