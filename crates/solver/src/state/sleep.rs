//! Sleep: which bodies at rest are not stepped, and what is kept of them until they wake.

use serde::{Deserialize, Serialize};

use super::contacts::ContactHistory;
use super::walls::{WallContact, WallLoad};

/// When a body falls asleep.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct SleepRule {
    /// No point of it is faster, m/s.
    pub speed_m_s: f64,
    /// It has been as slow for so long, s.
    pub after_s: f64,
}

/// Bodies that sleep, by the numbers of their clusters: clumps as well as clusters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Sleep {
    /// For each cluster whether it sleeps, and since when it has been slow, s (infinite: it is
    /// not). Clusters beyond the end are awake and not slow.
    pub of_cluster: Vec<ClusterSleep>,
    /// Contacts between particles that sleep, by pair. They are in no list of contacts.
    pub pairs: Vec<FrozenContact>,
    /// Contacts between particles that sleep and walls, by wall and particle.
    pub touches: Vec<FrozenWallContact>,
    /// Number of bodies that sleep.
    pub bodies: usize,
    /// Number of their particles.
    pub particles: usize,
    /// Number of their bonds that hold.
    pub bonds: u64,
    /// Particles times steps that were done, and that were left out.
    pub particle_steps: [u64; 2],
}

/// What is known of a cluster.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClusterSleep {
    /// Whether it sleeps.
    pub asleep: bool,
    /// Since when no point of it has been fast, s; infinite: since never.
    pub slow_since_s: f64,
}

impl ClusterSleep {
    /// Of a body that is awake and moves.
    pub const AWAKE: Self = Self {
        asleep: false,
        slow_since_s: f64::INFINITY,
    };
}

/// A contact between two particles that sleep.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrozenContact {
    /// The smaller number first.
    pub pair: [u32; 2],
    /// What it remembers.
    pub history: ContactHistory,
    /// J.
    pub elastic_j: f64,
}

/// A contact between a particle that sleeps and a wall at rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrozenWallContact {
    /// Which wall.
    pub wall: usize,
    /// What it remembers.
    pub touch: WallContact,
    /// What the wall does to the particle.
    pub push: WallLoad,
    /// J.
    pub elastic_j: f64,
}

impl Sleep {
    /// Whether a cluster sleeps.
    pub fn is_asleep(&self, cluster: u32) -> bool {
        let body = self.of_cluster.get(cluster as usize);
        body.is_some_and(|body| body.asleep)
    }

    /// Elastic energy of the contacts that are kept, J.
    pub fn elastic_j(&self) -> f64 {
        let pairs = self.pairs.iter().map(|kept| kept.elastic_j);
        let touches = self.touches.iter().map(|kept| kept.elastic_j);
        pairs.chain(touches).sum()
    }
}
