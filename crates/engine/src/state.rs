//! The state of a simulation as plain arrays: bodies, bonds, contacts and all other data that a
//! step needs.

pub mod bodies;
pub mod bonds;
pub mod bridges;
pub mod clump_touches;
pub mod clumps;
pub mod clusters;
pub mod contacts;
pub mod damping_memory;
pub mod damping_rate;
pub mod events;
pub mod islands;
pub(crate) mod ledger;
pub mod loads;
pub mod meetings;
pub mod model;
pub mod particles;
pub mod partitions;
pub mod population;
pub(crate) mod renumbered;
pub mod rigid_parts;
pub mod rules;
pub(crate) mod scratch;
pub mod search;
pub mod self_contacts;
pub mod sleep;
pub mod stored_bonds;
pub mod supports;
pub mod walls;
pub mod watches;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use dem_physics::bond::failure::CauseCounts;

use self::bonds::{BondRule, Bonds};
use self::bridges::Bridges;
use self::clumps::Clumps;
use self::clusters::Clusters;
use self::contacts::{ContactPartition, Contacts};
use self::damping_memory::DampingMemory;
use self::damping_rate::damping_rate_1_s;
use self::ledger::EnergyLedger;
use self::loads::GroupLoad;
use self::model::Model;
use self::particles::{Particles, Pose, Wrench};
use self::partitions::{Idle, count_busy, divide_busy};
use self::population::Population;
use self::renumbered::Renumbered;
use self::rigid_parts::RigidParts;
use self::scratch::Scratch;
use self::sleep::Sleep;
use self::supports::GroupSupport;
use self::walls::Wall;
use self::watches::Watch;

/// A simulation between two steps, in three parts: data fixed by the plan; data that change and are
/// saved, which form a checkpoint as they are; and data that can be rebuilt from the other two.
/// Poses are those of `time_s`, velocities those of half a step before; before the first step both
/// are the initial ones.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct State {
    /// Data fixed by the plan.
    #[serde(skip)]
    pub model: Model,

    /// Spheres: free ones first, then those carried by clumps.
    pub particles: Particles,
    /// Rigid clumps.
    pub clumps: Clumps,
    /// Bonds between particles.
    pub bonds: Bonds,
    /// Rigid parts of bonded bodies.
    pub rigid_parts: RigidParts,
    /// Particles grouped into connected pieces. None: nothing can break, and nothing can touch.
    pub clusters: Option<Clusters>,
    /// Bodies added, removed and replaced so far.
    pub population: Population,
    /// Contacts between particles of different clusters. None: nothing can touch.
    pub contacts: Option<Contacts>,
    /// Liquid bridges. None: no materials are wet.
    pub bridges: Option<Bridges>,
    /// Sleeping bodies. None: no body can sleep.
    pub sleep: Option<Sleep>,
    /// Walls, in the order of their names.
    pub walls: Vec<Wall>,
    /// Forces and contacts that measures record in every step. Empty: none.
    pub watches: Vec<Watch>,
    /// Loads.
    pub loads: Vec<GroupLoad>,
    /// Supports.
    pub supports: Vec<GroupSupport>,
    /// Steps done.
    pub steps: u64,
    /// Simulated time, s.
    pub time_s: f64,
    /// The next step, s.
    pub time_step_s: f64,
    /// The previous step, s; 0 at the start.
    pub previous_time_step_s: f64,
    /// Upper bound of the largest eigenvalue of the damping of bonds over mass, 1/s.
    pub damping_rate_1_s: f64,
    /// That of all bodies that are or may come, while no bond is much longer than at the start,
    /// 1/s. Infinite: it is not known.
    pub most_damping_rate_1_s: f64,
    /// Damping forces of bonds in the last step, one for each free particle. Empty: no bond
    /// has any.
    pub bond_resistance: Vec<Wrench>,
    /// Running means of these forces, from which those of the next step are predicted where one
    /// stage is enough for more than weak damping. Empty: they have not been needed.
    pub mean_resistance: Vec<Wrench>,
    /// What damping of bonds in one stage remembers beyond that.
    pub damping_memory: DampingMemory,
    /// Largest speed of a particle in the previous step, plus that of a wall if there are contacts,
    /// m/s.
    pub fastest_m_s: f64,
    /// Bonds broken so far.
    pub broken_count: u64,
    /// The same by cause of failure.
    pub broken_by_cause: CauseCounts,
    /// Those of them that were removed with their bodies.
    pub broken_removed: u64,
    /// Energy and momentum supplied and removed.
    pub ledger: EnergyLedger,

    /// Data that can be rebuilt.
    #[serde(skip)]
    pub scratch: Scratch,
}

impl State {
    /// A simulation of these particles and bonds, without loads, supports, gravity and particle
    /// damping. Work is divided for this number of threads.
    pub fn new(particles: Particles, bonds: Bonds, time_step_s: f64, threads: usize) -> Self {
        let mut state = Self {
            model: Model {
                bond_rules: Arc::clone(&bonds.rules),
                ..Model::default()
            },
            ledger: EnergyLedger::default(),
            population: Population {
                next_particle_id: particles.len() as u32,
                ..Population::default()
            },
            particles,
            clumps: Clumps::default(),
            bonds,
            rigid_parts: RigidParts::default(),
            clusters: None,
            contacts: None,
            bridges: None,
            sleep: None,
            walls: Vec::new(),
            watches: Vec::new(),
            loads: Vec::new(),
            supports: Vec::new(),
            steps: 0,
            time_s: 0.0,
            time_step_s,
            previous_time_step_s: 0.0,
            damping_rate_1_s: 0.0,
            most_damping_rate_1_s: f64::INFINITY,
            bond_resistance: Vec::new(),
            mean_resistance: Vec::new(),
            damping_memory: DampingMemory::default(),
            fastest_m_s: 0.0,
            broken_count: 0,
            broken_by_cause: CauseCounts::default(),
            broken_removed: 0,
            scratch: Scratch {
                threads,
                ..Scratch::default()
            },
        };
        state.divide();
        state
    }

    /// Whether no clump exists, and what inlets feed becomes single spheres at once.
    pub fn has_no_lasting_clump(&self) -> bool {
        let starts = &self.model.rules.starts;
        self.clumps.all.is_empty() && starts.iter().all(|start| start.sphere)
    }

    /// Whether there are clumps, or bodies can be added, removed or replaced.
    pub fn bodies_change(&self) -> bool {
        !(self.clumps.templates.is_empty() && self.model.rules.are_none())
    }

    /// Divides the work on particles and bonds again, and makes room for damping forces.
    pub fn divide(&mut self) {
        let free = self.particles.free;
        self.divide_bonds();
        let any = |is_so: fn(&BondRule) -> bool| self.bonds.rules.iter().any(is_so);
        let damped = if any(BondRule::is_damped) { free } else { 0 };
        let structural = any(|rule| rule.structural_damping > 0.0);
        let structural = if structural { self.bonds.len() } else { 0 };
        let rate_1_s = damping_rate_1_s(&self.bonds, &self.particles);
        self.damping_rate_1_s = rate_1_s.min(self.most_damping_rate_1_s);
        self.bond_resistance = vec![Wrench::default(); damped];
        if !self.mean_resistance.is_empty() {
            self.mean_resistance = self.bond_resistance.clone();
        }
        self.damping_memory.clear();
        let scratch = &mut self.scratch;
        scratch.damping_now = vec![[0.0; 4]; structural];
        scratch.damping_stages = std::array::from_fn(|_| vec![Wrench::default(); damped]);
        let is_damped = self.model.particle_damping > 0.0;
        let resistances = if is_damped { self.particles.len() } else { 0 };
        scratch.particle_resistance = vec![Wrench::default(); resistances];
    }

    /// The parts that name particles, and the poses of all particles.
    pub(crate) fn naming_particles(&mut self) -> (&[Pose], [&mut dyn Renumbered; 6]) {
        let parts: [&mut dyn Renumbered; 6] = [
            &mut self.supports,
            &mut self.loads,
            &mut self.rigid_parts,
            &mut self.walls,
            &mut self.bridges,
            &mut self.contacts,
        ];
        (&self.particles.poses, parts)
    }

    /// The lists of damping forces: of bonds, and on particles; each with one for each particle, or
    /// empty.
    pub(crate) fn resistances(&self) -> [&[Wrench]; 2] {
        [&self.bond_resistance, &self.scratch.particle_resistance]
    }

    /// Raises the bound of damping if bonds have become longer.
    pub fn renew_damping_rate(&mut self) {
        let rate_1_s = damping_rate_1_s(&self.bonds, &self.particles);
        self.damping_rate_1_s = self.damping_rate_1_s.max(rate_1_s);
        self.most_damping_rate_1_s = f64::INFINITY;
    }

    /// Number of partitions that the work is worth now: bodies come, leave, fall asleep and wake.
    pub(crate) fn wanted_partitions(&self) -> usize {
        let pairs = self.contacts.as_ref().map_or(0, |c| c.pairs.len());
        let items = self.scratch.busy + self.clumps.near.len() + pairs;
        let threads = self.scratch.threads;
        match items.checked_div(self.scratch.worth_a_thread) {
            Some(more) => threads.min(1 + more),
            None => threads,
        }
    }

    /// Divides the work on particles and bonds again.
    pub(crate) fn divide_bonds(&mut self) {
        let free = self.particles.free;
        self.scratch.busy = count_busy(&self.bonds, free, self.idle());
        let wanted = self.wanted_partitions();
        self.scratch.partitions = divide_busy(&self.bonds, free, wanted, self.idle());
    }

    /// What is not computed.
    pub(crate) fn idle(&self) -> Idle<'_> {
        Idle {
            asleep: &self.particles.asleep,
            part_of: &self.rigid_parts.of_particle,
        }
    }

    /// Leaves out of the lists of walls what they do not touch, and requests a search before the
    /// next step: which particles were near depends on when the last search was, and so on
    /// interruptions. When sleepers are next looked for does not change.
    pub fn forget_what_is_near(&mut self) {
        let Some(contacts) = self.contacts.as_mut() else {
            return;
        };
        for wall in &mut self.walls {
            wall.near.clear();
            wall.near
                .extend(wall.touching.iter().map(|touch| touch.particle));
            wall.near.dedup();
        }
        contacts.forget_references();
        if self.sleep.is_none() {
            contacts.skin_left_m = -1.0;
        }
    }

    /// The state from a checkpoint, with the model planned for it and everything that can be
    /// rebuilt, for the threads of this scratch. None: the two do not belong together.
    pub fn rebuilt(mut self, model: Model, planned: &Scratch) -> Option<Self> {
        let of_fragments = self.population.fragments.iter_mut();
        for fragment in of_fragments {
            let bonds = &mut Arc::make_mut(&mut fragment.template).bonds;
            Arc::make_mut(bonds).rules = Arc::clone(&model.bond_rules);
        }
        self.bonds.rules = Arc::clone(&model.bond_rules);
        let of_fragments = self.population.fragments.iter();
        let of_fragments = of_fragments.map(|fragment| &fragment.template);
        let templates = model.templates.iter().chain(of_fragments).cloned();
        self.clumps.templates = templates.collect();
        if self.walls.len() != model.walls.len() {
            return None;
        }
        for (wall, model) in self.walls.iter_mut().zip(&model.walls) {
            wall.model = Arc::clone(model);
        }
        if let Some(contacts) = &mut self.contacts {
            contacts.model = Arc::clone(model.contacts.as_ref()?);
        }
        self.model = model;
        self.scratch.threads = planned.threads;
        self.scratch.worth_a_thread = planned.worth_a_thread;
        self.rigid_parts.number(self.particles.free, &self.bonds);
        // Bonds that broke since it was found still count.
        let damping_rate_1_s = self.damping_rate_1_s;
        let damped = [&mut self.bond_resistance, &mut self.mean_resistance].map(std::mem::take);
        let memory = std::mem::take(&mut self.damping_memory);
        self.divide();
        self.damping_rate_1_s = damping_rate_1_s;
        let free = self.bond_resistance.len();
        [self.bond_resistance, self.mean_resistance] = damped;
        self.damping_memory = memory;
        let means = self.mean_resistance.len();
        let means_fit = means == 0 || means == free;
        if self.bond_resistance.len() != free || !means_fit || !self.damping_memory.fits(free) {
            return None;
        }
        self.particles.wrenches = vec![Wrench::default(); self.particles.len()];
        if let Some(clusters) = &mut self.clusters {
            clusters.rebuild(&self.bonds)?;
        }
        if let Some(contacts) = &mut self.contacts {
            contacts.divide(self.particles.len(), self.scratch.partitions.len().max(1));
        }
        self.open_islands();
        Some(self)
    }

    /// Begins to follow islands of pieces, with what is near each other now.
    pub fn open_islands(&mut self) {
        let (Some(contacts), Some(clusters)) = (&mut self.contacts, &self.clusters) else {
            return;
        };
        let islands = &mut contacts.islands;
        islands.open(self.walls.len(), clusters, !self.model.rules.are_none());
        islands.join_pairs(contacts.pairs.iter().copied(), clusters);
        if let Some(sleep) = &self.sleep {
            islands.join_pairs(sleep.pairs.iter().map(|frozen| frozen.pair), clusters);
        }
        if let Some(bridges) = &self.bridges {
            islands.join_pairs(bridges.pairs.iter().map(|bridge| bridge.pair), clusters);
        }
        for (number, wall) in (0..).zip(&self.walls).filter(|(_, wall)| wall.does_work()) {
            let wet = self.bridges.iter().flat_map(|bridges| &bridges.walls);
            let wet = wet.filter(|bridge| bridge.wall == number);
            let touching = wall.touching.iter().map(|touch| touch.particle);
            let near = wall.near.iter().copied().chain(touching);
            islands.join_with(
                number,
                near.chain(wet.map(|bridge| bridge.particle)),
                clusters,
            );
        }
    }

    /// The template of the scene that a template comes from.
    pub fn base_of(&self, template: u32) -> u32 {
        let of_scene = self.model.templates.len();
        match (template as usize).checked_sub(of_scene) {
            Some(fragment) => self.population.fragments[fragment].base,
            None => template,
        }
    }

    /// Density of particle `i`, kg/m3, whether a clump carries it or not.
    pub fn density_kg_m3(&self, i: usize) -> f64 {
        match self.clumps.carrier_of(i) {
            Some(at) => {
                let clump = &self.clumps.all[at];
                let template = self.clumps.template(clump);
                let sphere = template.outer[i - clump.first as usize] as usize;
                let sphere = &template.spheres[sphere];
                let volume = 4.0 / 3.0 * std::f64::consts::PI * sphere.radius_m.powi(3);
                sphere.mass_kg / volume
            }
            None => self.particles.density_kg_m3(i),
        }
    }

    /// Radius of the largest sphere that exists or may be added, m; 0 if there is none.
    pub fn largest_radius_m(&self) -> f64 {
        let of_clumps = self.clumps.templates.iter().flat_map(|template| {
            let radii = template.spheres.iter().map(|sphere| sphere.radius_m);
            radii.map(|radius| template.scale * radius)
        });
        of_clumps.fold(self.particles.largest_radius_m(), f64::max)
    }

    /// Radius of the smallest sphere that exists or may be added, m; infinite if there is none.
    pub fn smallest_radius_m(&self) -> f64 {
        let templates = self.clumps.templates.iter();
        let of_clumps = templates.flat_map(|t| t.spheres.iter().map(|sphere| sphere.radius_m));
        let of_daughters = self.model.rules.smallest_daughter_m();
        of_clumps.fold(
            self.particles.smallest_radius_m().min(of_daughters),
            f64::min,
        )
    }

    /// Length of the kick of this step: half of the previous step and half of the next, s.
    pub(crate) fn kick_s(&self) -> f64 {
        0.5 * (self.previous_time_step_s + self.time_step_s)
    }

    /// Division of the work on contacts.
    pub fn contact_partitions(&self) -> &[ContactPartition] {
        let contacts = self.contacts.as_ref();
        contacts.map_or(&[], |contacts| &contacts.scratch.partitions)
    }

    /// Whether particle `i` sleeps and does not ride.
    pub(crate) fn rests_asleep(&self, i: usize) -> bool {
        let (Some(sleep), Some(clusters)) = (&self.sleep, &self.clusters) else {
            return false;
        };
        self.particles.sleeps(i) && sleep.rests(clusters.of_particle[i])
    }

    /// The time and the length of the step that begins at it, s.
    pub(crate) fn moment(&self) -> [f64; 2] {
        [self.time_s, self.time_step_s]
    }

    /// The previous step and the next, s.
    pub fn steps_s(&self) -> [f64; 2] {
        [self.previous_time_step_s, self.time_step_s]
    }
}
