//! What moves and what joins it, as plain arrays; and all that a step needs besides.

pub mod bonds;
pub mod contacts;
pub mod order;
pub mod particles;
pub mod shares;
pub mod walls;

use crate::check::ledger::Ledger;
use crate::clock::StageClock;
use crate::clusters::{Clusters, Split, Triggers};
use crate::stages::breakage::Break;
use crate::stages::loads::SetLoad;
use crate::stages::supports::SetSupport;

use self::bonds::Bonds;
use self::contacts::Contacts;
use self::particles::{Particles, Wrench};
use self::shares::{Share, divide};
use self::walls::Wall;

/// A simulation between two steps. Poses stand at `time_s`, velocities half a step before; before the first step both stand at the start.
#[derive(Debug, Clone)]
pub struct State {
    /// Spheres.
    pub particles: Particles,
    /// What joins them.
    pub bonds: Bonds,
    /// Who works on what.
    pub shares: Vec<Share>,
    /// Which particles are of one piece. None: nothing can break, and nothing can touch.
    pub clusters: Option<Clusters>,
    /// When pieces are looked for.
    pub triggers: Triggers,
    /// Bonds that broke since pieces were looked for last.
    pub unsearched: Vec<u32>,
    /// Clusters that were found in pieces in this step.
    pub splits: Vec<Split>,
    /// Contacts between particles of different clusters. None: nothing can touch.
    pub contacts: Option<Contacts>,
    /// Walls, in the order of their names.
    pub walls: Vec<Wall>,
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
    /// Largest speed of a particle in the step before, and where there are contacts that of a wall on top, m/s.
    pub fastest_m_s: f64,
    /// Bonds that broke in the last kick.
    pub broken: Vec<Break>,
    /// Bonds broken so far.
    pub broken_count: u64,
    /// Energy and momentum that went in and out.
    pub ledger: Ledger,
    /// Where the time goes.
    pub clock: StageClock,
}

impl State {
    /// A simulation of these particles and bonds, without loads, supports, gravity and particle damping. Work is divided for this many threads.
    pub fn new(particles: Particles, bonds: Bonds, time_step_s: f64, threads: usize) -> Self {
        let damped = bonds.rules.iter().any(|rule| rule.damped);
        let shares = divide(&bonds, particles.len(), threads);
        let mut state = Self {
            bond_resistance: if damped {
                vec![Wrench::default(); particles.len()]
            } else {
                Vec::new()
            },
            ledger: Ledger::default(),
            particles,
            bonds,
            shares,
            clusters: None,
            triggers: Triggers::default(),
            unsearched: Vec::new(),
            splits: Vec::new(),
            contacts: None,
            walls: Vec::new(),
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
            broken: Vec::new(),
            broken_count: 0,
            clock: StageClock::default(),
        };
        state.ledger = Ledger::opened(&state);
        state
    }

    /// The lists of damping forces that are booked apart: of bonds and on particles; each with one for each particle, or empty.
    pub fn resistances(&self) -> [&[Wrench]; 2] {
        [&self.bond_resistance, &self.particle_resistance]
    }

    /// Length of the kick of this step: half of the step before and half of the step to come, s.
    pub fn kick_s(&self) -> f64 {
        0.5 * (self.previous_time_step_s + self.time_step_s)
    }
}
