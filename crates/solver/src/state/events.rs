//! What happened in a step.

use std::sync::Arc;

use super::clumps::{Clump, Template};
use super::clusters::Split;
use crate::physics::bond::failure::Cause;

/// What happened in a step, in the order in which it did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Events {
    /// Steps done before it.
    pub step: u64,
    /// Time of its kick, s.
    pub time_s: f64,
    /// Bonds that broke in the kick.
    pub broken: Vec<Break>,
    /// Clusters that were found in pieces.
    pub splits: Vec<Split>,
    /// Bodies that came, left, or became others.
    pub population: Vec<PopulationEvent>,
    /// How particles and bonds are counted after each of the changes that this took.
    pub renumberings: Vec<Renumbering>,
    /// Bodies that fell asleep or woke.
    pub sleep: Vec<SleepEvent>,
    /// Work that stages did within others.
    pub work: Work,
}

/// Work that stages did within others.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Pairs that were listed and begin their law at an overlap.
    pub relaxing: usize,
    /// Bonds that were looked at whose strength depends on the rate of strain.
    pub rates: usize,
}

impl Events {
    /// Nothing has happened yet in a step that begins now.
    pub(crate) fn begin(&mut self, step: u64, time_s: f64) {
        self.step = step;
        self.time_s = time_s;
        self.broken.clear();
        self.splits.clear();
        self.population.clear();
        self.renumberings.clear();
        self.sleep.clear();
        self.work = Work::default();
    }
}

/// A bond that has broken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Break {
    /// Which bond.
    pub bond: u32,
    /// Halfway between its ends, m. Length 3.
    pub place_m: [f64; 3],
    /// What it failed by.
    pub cause: Cause,
    /// Elastic energy that it held, J.
    pub released_j: f64,
    /// Its two particles, and the force, N, and torque, N m, on each: x, y, z of both. They acted
    /// until the break.
    pub ends: [(u32, [f64; 6]); 2],
}

/// What has happened to bodies in a step.
#[derive(Debug, Clone, PartialEq)]
pub enum PopulationEvent {
    /// A clump has become a bonded cluster.
    Replaced {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// Which condition was met: `enters`, `force`, `impact_energy`, `time`, `start`.
        cause: &'static str,
        /// Mass before and after, kg.
        mass_kg: [f64; 2],
        /// Magnitude of the momentum before and after, N s.
        momentum_n_s: [f64; 2],
        /// Kinetic energy before and after, J.
        kinetic_j: [f64; 2],
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
    /// A cluster has become a clump again.
    Restored {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// Number of its particles.
        particles: u32,
        /// Strain and inner motion that it had, J.
        lost_j: f64,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
    /// A body has come.
    Came {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// Name of the inlet.
        inlet: String,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
    /// A body or a fragment has gone.
    Left {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of the outlet.
        outlet: String,
        /// Its mass, kg.
        mass_kg: f64,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
}

/// Cause of the change of a body that comes through an inlet and starts as bonded.
pub const STARTS_BONDED: &str = "start";

/// Bodies that fell asleep or woke together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SleepEvent {
    /// At this step.
    pub step: u64,
    /// s.
    pub time_s: f64,
    /// `asleep` or `awake`.
    pub kind: &'static str,
    /// Why: `rest`; `near` something that moves; `changed` into something else, or gone.
    pub cause: &'static str,
    /// How many.
    pub bodies: usize,
}

/// Number of a particle or bond that has been removed.
pub const REMOVED: u32 = u32::MAX;

/// A clump that has become a bonded cluster.
#[derive(Debug, Clone, PartialEq)]
pub struct NewCluster {
    /// As it was.
    pub clump: Clump,
    /// What it is made of.
    pub template: Arc<Template>,
    /// First of its particles.
    pub first_particle: usize,
    /// First of its bonds.
    pub first_bond: usize,
}

/// How particles and bonds are counted now.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Renumbering {
    /// For each particle before, its number now, or [`REMOVED`].
    pub particles: Vec<u32>,
    /// For each bond before, its number now, or [`REMOVED`].
    pub bonds: Vec<u32>,
    /// Particles from this number on are carried by clumps.
    pub free: u32,
    /// Clusters that clumps have become.
    pub created: Vec<NewCluster>,
}

/// Bodies that are to come, leave and become others.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TopologyChange {
    /// Clumps that become bonded clusters: numbers, rising.
    pub to_clusters: Vec<usize>,
    /// Clusters that become clumps: their numbers, rising, and the clumps.
    pub to_clumps: Vec<(u32, Clump)>,
    /// Clumps that come.
    pub coming: Vec<Clump>,
    /// Clusters that leave, be they clumps or not: their numbers, rising.
    pub leaving: Vec<u32>,
}
