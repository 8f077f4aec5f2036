//! What moves and what joins it, as plain arrays; and all that a step needs besides.

pub mod bodies;
pub mod bonds;
pub mod clumps;
pub mod clusters;
pub mod contacts;
pub mod events;
pub mod ledger;
pub mod loads;
pub mod order;
pub mod particles;
pub mod partitions;
pub mod regions;
pub mod rules;
pub mod sleep;
pub mod supports;
pub mod walls;
pub mod watches;

use crate::clock::StageClock;
use crate::physics::bond::failure::CauseCounts;

use self::bonds::Bonds;
use self::clumps::Clumps;
use self::clusters::{Clusters, Triggers};
use self::contacts::Contacts;
use self::events::Events;
use self::ledger::EnergyLedger;
use self::loads::SetLoad;
use self::particles::{Particles, Wrench};
use self::partitions::{Partition, divide};
use self::rules::Rules;
use self::sleep::Sleep;
use self::supports::SetSupport;
use self::walls::Wall;
use self::watches::Watch;

/// A simulation between two steps. Poses stand at `time_s`, velocities half a step before; before
/// the first step both stand at the start.
#[derive(Debug, Clone)]
pub struct State {
    /// Spheres: first those that move by themselves, then those that clumps carry.
    pub particles: Particles,
    /// Rigid clumps.
    pub clumps: Clumps,
    /// What joins them.
    pub bonds: Bonds,
    /// Number of partitions in which the work is divided, at most.
    pub threads: usize,
    /// Who works on what.
    pub partitions: Vec<Partition>,
    /// Which particles are of one piece. None: nothing can break, and nothing can touch.
    pub clusters: Option<Clusters>,
    /// When pieces are looked for.
    pub triggers: Triggers,
    /// Bonds that broke since pieces were looked for last.
    pub unsearched: Vec<u32>,
    /// When bodies come, go, and become others.
    pub rules: Rules,
    /// Contacts between particles of different clusters. None: nothing can touch.
    pub contacts: Option<Contacts>,
    /// Bodies that sleep. None: none can.
    pub sleep: Option<Sleep>,
    /// Walls, in the order of their names.
    pub walls: Vec<Wall>,
    /// Forces and contacts that measures follow in every step. Empty: none.
    pub watches: Vec<Watch>,
    /// Loads.
    pub loads: Vec<SetLoad>,
    /// Supports.
    pub supports: Vec<SetSupport>,
    /// m/s2. Length 3.
    pub gravity_m_s2: [f64; 3],
    /// gamma of Chen et al. 2022, eqs. 11 and 12. 0: none.
    pub particle_damping: f64,
    /// Damping forces of bonds. Empty: no bond is damped.
    pub bond_resistance: Vec<Wrench>,
    /// Damping forces on particles. Empty: none.
    pub particle_resistance: Vec<Wrench>,
    /// Steps done.
    pub steps: u64,
    /// Simulated time, s.
    pub time_s: f64,
    /// The step to come, s.
    pub time_step_s: f64,
    /// The step before, s; 0 at the start.
    pub previous_time_step_s: f64,
    /// Largest speed of a particle in the step before, and where there are contacts that of a wall
    /// on top, m/s.
    pub fastest_m_s: f64,
    /// What happened in the last step.
    pub events: Events,
    /// Bonds broken so far.
    pub broken_count: u64,
    /// The same by what they failed by.
    pub broken_by_cause: CauseCounts,
    /// Those of them that have gone with their bodies.
    pub broken_gone: u64,
    /// Energy and momentum that went in and out.
    pub ledger: EnergyLedger,
    /// Where the time goes.
    pub clock: StageClock,
}

impl State {
    /// A simulation of these particles and bonds, without loads, supports, gravity and particle
    /// damping. Work is divided for this many threads.
    pub fn new(particles: Particles, bonds: Bonds, time_step_s: f64, threads: usize) -> Self {
        let damped = bonds.rules.iter().any(|rule| rule.damped);
        let partitions = divide(&bonds, particles.len(), threads);
        Self {
            bond_resistance: if damped {
                vec![Wrench::default(); particles.len()]
            } else {
                Vec::new()
            },
            ledger: EnergyLedger::default(),
            particles,
            clumps: Clumps::default(),
            bonds,
            threads,
            partitions,
            clusters: None,
            triggers: Triggers::default(),
            unsearched: Vec::new(),
            rules: Rules::default(),
            contacts: None,
            sleep: None,
            walls: Vec::new(),
            watches: Vec::new(),
            loads: Vec::new(),
            supports: Vec::new(),
            gravity_m_s2: [0.0; 3],
            particle_damping: 0.0,
            particle_resistance: Vec::new(),
            steps: 0,
            time_s: 0.0,
            time_step_s,
            previous_time_step_s: 0.0,
            fastest_m_s: 0.0,
            events: Events::default(),
            broken_count: 0,
            broken_by_cause: CauseCounts::default(),
            broken_gone: 0,
            clock: StageClock::default(),
        }
    }

    /// The lists of damping forces that are booked apart: of bonds and on particles; each with one
    /// for each particle, or empty.
    pub fn resistances(&self) -> [&[Wrench]; 2] {
        [&self.bond_resistance, &self.particle_resistance]
    }

    /// Density of particle `i`, kg/m3, be it carried by a clump or not.
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

    /// Radius of the largest sphere that is there or may come, m; 0 where there is none.
    pub fn largest_radius_m(&self) -> f64 {
        let of_clumps = self.clumps.templates.iter().flat_map(|template| {
            let radii = template.spheres.iter().map(|sphere| sphere.radius_m);
            radii.map(|radius| template.scale * radius)
        });
        of_clumps.fold(self.particles.largest_radius_m(), f64::max)
    }

    /// Radius of the smallest sphere that is there or may come, m; infinite where there is none.
    pub fn smallest_radius_m(&self) -> f64 {
        let templates = self.clumps.templates.iter();
        let of_clumps = templates.flat_map(|t| t.spheres.iter().map(|sphere| sphere.radius_m));
        of_clumps.fold(self.particles.smallest_radius_m(), f64::min)
    }

    /// Length of the kick of this step: half of the step before and half of the step to come, s.
    pub fn kick_s(&self) -> f64 {
        0.5 * (self.previous_time_step_s + self.time_step_s)
    }

    /// The step before and the one to come, s.
    pub fn steps_s(&self) -> [f64; 2] {
        [self.previous_time_step_s, self.time_step_s]
    }
}
