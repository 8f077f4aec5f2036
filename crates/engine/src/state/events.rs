//! Events of a step.

use std::sync::Arc;

use super::clumps::{Clump, Template};
use super::clusters::Split;
use dem_physics::bond::failure::Cause;

/// Events of a step, in chronological order.
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
    /// Bodies added, removed or replaced.
    pub population: Vec<PopulationEvent>,
    /// New numbers of particles and bonds after each of these changes.
    pub renumberings: Vec<Renumbering>,
    /// Spheres that were released from rigid parts of bodies or joined them again.
    pub zones: Vec<ZoneEvent>,
    /// Bodies that fell asleep or woke.
    pub sleep: Vec<SleepEvent>,
    /// Work that stages did as part of others.
    pub work: Work,
}

/// Work that stages did as part of others.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Newly listed pairs whose law begins at an overlap.
    pub relaxing: usize,
    /// Bonds checked whose strength depends on the strain rate.
    pub rates: usize,
}

impl Events {
    /// Clears the events for a step that begins now.
    pub(crate) fn begin(&mut self, step: u64, time_s: f64) {
        self.step = step;
        self.time_s = time_s;
        self.broken.clear();
        self.splits.clear();
        self.population.clear();
        self.renumberings.clear();
        self.zones.clear();
        self.sleep.clear();
        self.work = Work::default();
    }
}

/// A bond that has broken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Break {
    /// Number of the bond.
    pub bond: u32,
    /// Halfway between its ends, m. Length 3.
    pub place_m: [f64; 3],
    /// Cause of failure.
    pub cause: Cause,
    /// Elastic energy that it stored, J.
    pub released_j: f64,
    /// The strain rate that determined its strength, 1/s, and the factor on it. None: no rate does.
    pub strengthened: Option<[f64; 2]>,
    /// Its two particles, and the force, N, and torque, N m, on each: x, y, z of both. They acted
    /// until the break.
    pub ends: [(u32, [f64; 6]); 2],
}

/// Events of bodies in a step.
#[derive(Debug, Clone, PartialEq)]
pub enum PopulationEvent {
    /// A clump has become a bonded cluster.
    Replaced {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// The condition that was met: `enters`, `force`, `impact_energy`, `time`, `start`.
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
    /// Daughters have replaced a particle.
    Broken {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// What the daughters follow from.
        into: BrokenInto,
        /// Name of the body of the daughters, and their number.
        daughters: (String, usize),
        /// Energy over mass that it had taken in, J/kg.
        specific_j_kg: f64,
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
        /// Strain energy and kinetic energy of internal motion that it lost, J.
        lost_j: f64,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
    /// A body has entered through an inlet.
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
    /// A body or a fragment has left through an outlet.
    Left {
        /// Its number among the clusters.
        cluster: u32,
        /// Name of its body.
        body: String,
        /// Name of the outlet.
        outlet: String,
        /// Its mass, kg.
        mass_kg: f64,
        /// Centre of mass, m. Length 3.
        place_m: [f64; 3],
    },
}

/// What the daughters of a particle follow from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BrokenInto {
    /// The size class with this number, from 0.
    Class(usize),
    /// The breakage law of the material.
    Law {
        /// Part of its mass below a tenth of its size.
        t10: f64,
        /// Mass of fragments that are too small to be made, kg.
        fines_kg: f64,
    },
}

/// Cause of replacement for a body that comes through an inlet and starts as bonded.
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
    /// Cause: `rest`; `near` something that moves, or that a rider approaches; at the `edge` of a
    /// belt; `changed` into something else, or removed.
    pub cause: &'static str,
    /// Number of bodies.
    pub bodies: usize,
}

/// Spheres of a body bonded in part that were released from its rigid parts or joined them again,
/// together.
#[derive(Debug, Clone, PartialEq)]
pub struct ZoneEvent {
    /// At this step.
    pub step: u64,
    /// s.
    pub time_s: f64,
    /// `released` or `rejoined`.
    pub kind: &'static str,
    /// Name of the body.
    pub body: String,
    /// Number of spheres.
    pub particles: usize,
    /// Kinetic energy that they lost, J.
    pub lost_j: f64,
}

pub use super::renumbered::REMOVED;

/// A clump that has become a bonded cluster.
#[derive(Debug, Clone, PartialEq)]
pub struct NewCluster {
    /// Its former data.
    pub clump: Clump,
    /// Its template.
    pub template: Arc<Template>,
    /// First of its particles.
    pub first_particle: usize,
    /// First of its bonds.
    pub first_bond: usize,
}

/// New numbers of particles and bonds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Renumbering {
    /// For each old particle, its new number, or `REMOVED`.
    pub particles: Vec<u32>,
    /// For each old bond, its new number, or `REMOVED`.
    pub bonds: Vec<u32>,
    /// Particles from this number on are carried by clumps.
    pub free: u32,
    /// Clusters made from clumps.
    pub created: Vec<NewCluster>,
}

/// Bodies to be added, removed and replaced.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TopologyChange {
    /// Clumps that become bonded clusters: numbers, ascending.
    pub to_clusters: Vec<usize>,
    /// Clusters that become clumps: their numbers, ascending, and the clumps.
    pub to_clumps: Vec<(u32, Clump)>,
    /// Clumps to be added.
    pub coming: Vec<Clump>,
    /// Clusters to be removed, clumps or not: their numbers, ascending.
    pub leaving: Vec<u32>,
}
