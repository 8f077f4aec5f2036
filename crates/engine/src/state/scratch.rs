//! Data that can be rebuilt from the other parts of a state, or are valid for one step only.

use super::bridges::BridgeScratch;
use super::clump_touches::ClumpTouch;
use super::clusters::Clusters;
use super::events::Events;
use super::meetings::{JointBuffers, Meetings};
use super::particles::{Motion, Wrench};
use super::partitions::Partition;
use super::population::{OutletWatch, Surroundings};
use crate::clock::StageClock;
use dem_physics::chebyshev::Chebyshev;
use dem_physics::clump_stress::Squeeze;

/// Data that can be rebuilt from the other parts of a state, or are valid for one step only.
/// Contacts, clusters and walls have such parts of their own.
#[derive(Debug, Clone, Default)]
pub struct Scratch {
    /// Largest number of partitions of the work.
    pub threads: usize,
    /// Number of particles, bonds and pairs that are worth a thread of their own; 0: any number is.
    pub worth_a_thread: usize,
    /// Number of free particles and bonds that are computed.
    pub(crate) busy: usize,
    /// Division of particles and bonds among threads.
    pub partitions: Vec<Partition>,
    /// Coefficients of damping of bonds in this step, structural damping included: as
    /// [`super::bonds::Bonds::damping`]. Empty: no bond has structural damping.
    pub damping_now: Vec<[f64; 4]>,
    /// Part of what damping of bonds takes in this step that structural damping takes.
    pub structural_share: f64,
    /// Damping forces on particles. Empty: none.
    pub particle_resistance: Vec<Wrench>,
    /// What is joined by bonds, where local damping needs it and the scene has no clusters.
    pub pieces: Option<Clusters>,
    /// Motions of the free particles at the time of their poses, without viscous damping of bonds
    /// or with that of the last step, and in a stage of it. Length 0 or free particles.
    pub predicted: [Vec<Motion>; 2],
    /// Impulses of the damping of bonds after the last stage but one and the last, N s and N m s;
    /// its forces in the first stage, N and N m. Length as [`super::State::bond_resistance`].
    pub damping_stages: [Vec<Wrench>; 3],
    /// Passes of damping over the bonds so far.
    pub damping_passes: u64,
    /// The largest eigenvalue of the last step, and the factors of stages for it.
    pub stages: Option<(f64, Chebyshev)>,
    /// For each chunk of free particles the distance that the fastest of them moved in the last
    /// drift, m.
    pub chunks_moved_m: Vec<f64>,
    /// Where particles meet a wall: for each chunk of those near it.
    pub meetings: Vec<Meetings>,
    /// Meetings of particles that touch several walls.
    pub(crate) joints: JointBuffers,
    /// What touches each sphere that a clump carries. All are cleared between steps.
    pub clump_touches: Vec<ClumpTouch>,
    /// Power that each clump takes in, W: see `stages/population/absorbed_energy.rs`.
    pub powers_w: Vec<Option<f64>>,
    /// Damaged bonds that have reached their compressive strength.
    pub(crate) crushed: Vec<u32>,
    /// How contacts squeeze each clump. Empty: no trigger needs it.
    pub(crate) squeezes: Vec<Squeeze>,
    /// Whether each clump touches what its trigger names. Empty: no trigger names anything.
    pub(crate) touched: Vec<bool>,
    /// The liquid bridges in this step.
    pub(crate) bridges: BridgeScratch,
    /// Contacts that triggers have read in this step.
    pub(crate) squeezing: usize,
    /// Surroundings of each inlet. Empty once particles or clumps have come, gone or got other
    /// numbers; to be cleared as well by whoever moves them between steps.
    pub surroundings: Vec<Surroundings>,
    /// The clusters near outlets. Empty once clusters have come, gone or changed to clumps or back.
    pub outlets: OutletWatch,
    /// Events of the last step.
    pub events: Events,
    /// Time spent in each stage.
    pub clock: StageClock,
}
