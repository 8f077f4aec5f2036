//! Steps by body: a body of level k takes steps of 2^k times the time step (block time steps).
//!
//! Bodies that may touch each other have the same level. All bodies are at the same time once in
//! [`CYCLE`] time steps: only then levels change, neighbours are searched for and results are
//! measured.

use serde::{Deserialize, Serialize};

use super::asleep::Asleep;
use super::contacts::ContactPartition;
use super::events::Break;
use super::partitions::Partition;
use super::walls::{Wall, WallContact, WallLoad};

/// The highest level.
pub const HIGHEST: u8 = 3;
/// Number of time steps from one common time to the next.
pub const CYCLE: u64 = 1 << HIGHEST;

/// Largest number of groups: of pairs of levels, before a kick and after it.
pub(crate) const MOST_GROUPS: usize = (HIGHEST as usize + 1).pow(2);

/// Length of a step of a level in time steps. Products with it are exact.
pub(crate) fn length(level: u8) -> f64 {
    f64::from(1_u32 << level)
}

/// What the levels follow from, by the plan.
#[derive(Debug, Clone, Default)]
pub struct LevelRule {
    /// For each bonded body at the start, then for each shape that a cluster may have later, the
    /// largest eigenvalue of M^-1 K, alone in space, 1/s2.
    pub own: Vec<f64>,
    /// For each template of clumps the number of its cluster in `own`. Length templates.
    pub own_of_template: Vec<u32>,
    /// For each material the largest eigenvalues that the first impacts of free particles add, 1/s2
    /// and 1/s.
    pub impact_rates: Vec<[f64; 2]>,
    /// The same for the clumps of each template. Length templates.
    pub impact_rates_of_clumps: Vec<[f64; 2]>,
    /// Speed of those impacts, m/s.
    pub impact_speed_m_s: f64,
    /// The safety factor of the step, and of the step that impacts allow.
    pub safety: [f64; 2],
}

impl LevelRule {
    /// Largest eigenvalues that the first impact of a free particle adds, 1/s2 and 1/s.
    pub(crate) fn impact_of_particle(&self, material: u8) -> [f64; 2] {
        let found = self.impact_rates.get(usize::from(material));
        found.copied().unwrap_or_default()
    }
}

/// The levels of all bodies.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Levels {
    /// For each particle the level of its body.
    pub of_particle: Vec<u8>,
    /// For each particle the number, in the rule, of the bonded body that it belonged to when that
    /// was whole, or that its clump can become.
    pub(crate) whole_of: Vec<u32>,
    /// Whether a body has become a clump, whose limit is to be looked at.
    pub(crate) looks_next: bool,
    /// Clusters of the clumps whose trigger has fired, which become bonded once they take single
    /// time steps, and the numbers of the conditions.
    pub(crate) fired: Vec<(u32, usize)>,
    /// Expected motion of each group of particles, in their order. Empty before the first step.
    pub(crate) shares: Vec<Share>,
    /// Number of particles times time steps, and of the steps of particles.
    pub particle_steps: [u64; 2],
    /// Data that can be rebuilt.
    #[serde(skip)]
    pub(crate) scratch: LevelScratch,
}

impl Levels {
    /// Fraction of particle updates that was skipped because bodies took longer steps; 0 before the
    /// first step.
    pub(crate) fn updates_skipped(&self) -> f64 {
        let [all, done] = self.particle_steps.map(|count| count as f64);
        if all > 0.0 { 1.0 - done / all } else { 0.0 }
    }
}

/// Part of the ledger that belongs to the particles of a group.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Share {
    pub(crate) mass_kg: f64,
    /// Sum of mass times position, as in the ledger, kg m.
    pub(crate) first_moment: [f64; 3],
    /// N s.
    pub(crate) momentum: [f64; 3],
}

impl Share {
    /// Adds a mass, kg, at a place from the centre of the ledger, m, with a velocity, m/s.
    pub(crate) fn add(&mut self, mass_kg: f64, from_m: [f64; 3], velocity_m_s: [f64; 3]) {
        self.mass_kg += mass_kg;
        for k in 0..3 {
            self.first_moment[k] += mass_kg * from_m[k];
            self.momentum[k] += mass_kg * velocity_m_s[k];
        }
    }
}

/// Data of levels that can be rebuilt from the other parts of a state.
#[derive(Debug, Clone, Default)]
pub(crate) struct LevelScratch {
    /// The groups. Empty: the particles are to be grouped again.
    pub(crate) groups: Vec<Group>,
    /// Level of the group that is being stepped.
    pub(crate) stepping: u8,
    /// Length as the walls.
    pub(crate) walls: Vec<OfWall>,
    /// For each level the loads of the walls on its particles in their last step. Length walls.
    pub(crate) pushes: [Vec<WallLoad>; HIGHEST as usize + 1],
    /// Number of bonds that had broken when the groups were made.
    pub(crate) broken_count: u64,
    /// Bonds that broke at the last common time, kept until the next.
    pub(crate) broken: Vec<Break>,
    /// Whether particles have other numbers than when the groups were made.
    pub(crate) is_renumbered: bool,
    /// Whether pairs have been listed anew since the groups were made.
    pub(crate) is_relisted: bool,
    /// For each particle its level in the step just made. Empty: the present one.
    pub(crate) before: Vec<u8>,
    /// For each chunk of particles the distance that the fastest of them moves in a cycle, m.
    pub(crate) chunks_moved_m: Vec<f64>,
    /// For each clump the distance that it has moved in this cycle, m.
    pub(crate) clumps_moved_m: Vec<f64>,
    /// For each wall the distance that it has moved in this cycle, m.
    pub(crate) walls_moved_m: Vec<f64>,
    /// Largest speed of a particle in this cycle, m/s.
    pub(crate) fastest_m_s: f64,
    /// Largest speed of a wall near particles in this cycle, m/s.
    pub(crate) fastest_wall_m_s: f64,
}

/// Particles that make the same steps. What it holds takes the place of the arrays of the state
/// while the group is stepped.
#[derive(Debug, Clone, Default)]
pub(crate) struct Group {
    /// Level in the step before, and in the present one.
    pub(crate) levels: [u8; 2],
    /// For each particle whether it is in another group.
    pub(crate) others: Asleep,
    /// Number of threads that its particles and bonds are worth.
    pub(crate) threads: usize,
    /// Division of its particles and bonds.
    pub(crate) partitions: Vec<Partition>,
    /// Division of its contacts.
    pub(crate) contacts: Vec<ContactPartition>,
    /// See [`super::contacts::ContactScratch`].
    pub(crate) close_m: f64,
    pub(crate) close_skin_left_m: f64,
    /// Distance that its fastest particle moved in its last step, m.
    pub(crate) moved_m: f64,
    /// For each wall the particles near it, and its contacts.
    pub(crate) walls: Vec<(Vec<u32>, Vec<WallContact>)>,
}

/// What the groups add to a wall.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct OfWall {
    pub(crate) push: WallLoad,
    pub(crate) damping: WallLoad,
    pub(crate) elastic_j: f64,
    pub(crate) stiffness_n_m: f64,
    pub(crate) pending_j: f64,
}

impl OfWall {
    pub(crate) fn add(&mut self, wall: &mut Wall) {
        let both = [
            (&mut self.push, &wall.push),
            (&mut self.damping, &wall.scratch.damping),
        ];
        for (sum, load) in both {
            sum.add(load.force_n, load.torque_n_m, load.belt_w);
        }
        self.elastic_j += wall.scratch.elastic_j;
        self.stiffness_n_m += wall.stiffness_n_m;
        self.pending_j += std::mem::take(&mut wall.pending_j);
    }
}
