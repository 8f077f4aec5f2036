//! Sleep: bodies at rest that are skipped, and the data kept until they wake.

pub mod mask;

use serde::{Deserialize, Serialize};

use super::contacts::ContactHistory;
use super::walls::{WallContact, WallLoad};
use dem_physics::geometry::Bounds;

/// Conditions under which a body falls asleep.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct SleepRule {
    /// No point of it exceeds this speed, m/s.
    pub speed_m_s: f64,
    /// It has been slow for this time, s.
    pub after_s: f64,
}

/// Sleeping bodies, by the numbers of their clusters: clumps as well as clusters.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Sleep {
    /// For each cluster whether it sleeps, and since when it has been slow, s (infinite: it is
    /// not). Clusters beyond the end of the list are awake and not slow.
    pub of_cluster: Vec<ClusterSleep>,
    /// Contacts between sleeping particles, by pair. They are in no list of contacts.
    pub pairs: Vec<FrozenContact>,
    /// Contacts between sleeping particles and walls, by wall and particle.
    pub touches: Vec<FrozenWallContact>,
    /// Those of the sleeping bodies that ride on a moving surface, by their clusters.
    pub riders: Vec<Rider>,
    /// Largest speed of a rider, m/s.
    pub riding_m_s: f64,
    /// Time before which no rider can come near anything that moves steadily but not with it, or
    /// come to the edge of what carries it, s.
    pub due_s: f64,
    /// Distance that riders may approach anything else before they could come near it, m.
    pub left_m: f64,
    /// Number of sleeping bodies.
    pub bodies: usize,
    /// Number of their particles.
    pub particles: usize,
    /// Number of their unbroken bonds.
    pub bonds: u64,
    /// Particle updates done, and skipped.
    pub particle_steps: [u64; 2],
    /// For each chunk of particles the box around those that sleep and do not ride, m. Empty: to be
    /// found.
    #[serde(skip)]
    pub(crate) boxes: Vec<Bounds>,
}

/// Sleep data of a cluster.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ClusterSleep {
    /// Whether it sleeps.
    pub asleep: bool,
    /// Time since which no point of it has been fast, s; infinite: it is fast.
    pub slow_since_s: f64,
    /// Velocity of the surface relative to which it has been slow, and with which it rides, m/s; 0:
    /// it rests.
    pub velocity_m_s: [f64; 3],
}

/// A body asleep that moves with the surface on which it lies.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Rider {
    /// Its number.
    pub cluster: u32,
    /// m/s.
    pub velocity_m_s: [f64; 3],
    /// The wall that carries it and all that sleep with it.
    pub wall: u32,
    /// Time at which the first of them comes to the edge of the face of a belt, s.
    pub until_s: f64,
    /// The smallest and the largest corner of the box around it, relative to its place: that of a
    /// clump, or of its first particle, m.
    pub corners_m: [[f64; 3]; 2],
}

impl ClusterSleep {
    /// For a body that is awake and moves.
    pub(crate) const AWAKE: Self = Self {
        asleep: false,
        slow_since_s: f64::INFINITY,
        velocity_m_s: [0.0; 3],
    };
}

/// A contact between two sleeping particles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrozenContact {
    /// The smaller number first.
    pub pair: [u32; 2],
    /// Its history.
    pub history: ContactHistory,
    /// J.
    pub elastic_j: f64,
}

/// A contact between a sleeping particle and a wall at rest, or one on which it rides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FrozenWallContact {
    /// Which wall.
    pub wall: usize,
    /// Its history.
    pub touch: WallContact,
    /// Load of the wall on the particle, at this time, s.
    pub push: WallLoad,
    /// See `push`.
    pub at_s: f64,
    /// Where the wall touched it at that time, in the wall's frame, m. Length 3.
    pub foot_m: [f64; 3],
    /// J.
    pub elastic_j: f64,
}

impl Sleep {
    /// Whether a cluster sleeps.
    pub(crate) fn is_asleep(&self, cluster: u32) -> bool {
        let body = self.of_cluster.get(cluster as usize);
        body.is_some_and(|body| body.asleep)
    }

    /// Whether a cluster sleeps and does not ride.
    pub(crate) fn rests(&self, cluster: u32) -> bool {
        let body = self.of_cluster.get(cluster as usize);
        body.is_some_and(|body| body.asleep && body.velocity_m_s == [0.0; 3])
    }

    /// Elastic energy of the frozen contacts, J.
    pub fn elastic_j(&self) -> f64 {
        let pairs = self.pairs.iter().map(|kept| kept.elastic_j);
        let touches = self.touches.iter().map(|kept| kept.elastic_j);
        pairs.chain(touches).sum()
    }
}
