//! What each stage of a step takes and does: one step in `EVERY` is timed stage by stage, what is written down or checked is timed always; and what a stage
//! does is counted where it is done, so that it can be shown that a stage that a scene does not need does nothing.

use std::time::{Duration, Instant};

/// One step in so many is timed.
pub const EVERY: u64 = 16;

/// The stages of a step, and what goes on between steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Forces of bonds.
    Bonds,
    /// Histories of bonds of the incremental formulation, and their forces.
    Histories,
    /// Bonds that have reached their strength.
    Failure,
    /// Their strength by the rate of strain.
    Rates,
    /// Strengths that vary from bond to bond.
    Scatter,
    /// The search for pieces.
    Clusters,
    /// The search for what is near.
    Search,
    /// Contacts of particles.
    Contacts,
    /// Overlaps of pieces that part.
    Relaxation,
    /// Rolling friction of contacts.
    Rolling,
    /// Contacts with walls, and their motion.
    Walls,
    /// Rigid clumps.
    Clumps,
    /// Clumps that become clusters, and clusters that become clumps.
    Replacement,
    /// Inlets and outlets.
    Population,
    /// Who sleeps.
    Sleep,
    /// Damping of bonds.
    BondDamping,
    /// Damping of particles.
    ParticleDamping,
    /// Loads.
    Loads,
    /// Supports.
    Supports,
    /// Gravity.
    Gravity,
    /// Kick and drift of particles.
    Motion,
    /// The books of energy and momentum.
    EnergyLedger,
    /// Looks at the limit of the step and at energy.
    Checks,
    /// Measures, files and pictures.
    Output,
}

/// Number of stages.
const STAGES: usize = Stage::ALL.len();

impl Stage {
    /// All, in the order of the table.
    pub const ALL: [Self; 24] = [
        Self::Bonds,
        Self::Histories,
        Self::Failure,
        Self::Rates,
        Self::Scatter,
        Self::Clusters,
        Self::Search,
        Self::Contacts,
        Self::Relaxation,
        Self::Rolling,
        Self::Walls,
        Self::Clumps,
        Self::Replacement,
        Self::Population,
        Self::Sleep,
        Self::BondDamping,
        Self::ParticleDamping,
        Self::Loads,
        Self::Supports,
        Self::Gravity,
        Self::Motion,
        Self::EnergyLedger,
        Self::Checks,
        Self::Output,
    ];

    /// For a person.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bonds => "bond forces",
            Self::Histories => "bond history",
            Self::Failure => "failure",
            Self::Rates => "strength by rate",
            Self::Scatter => "scattered strength",
            Self::Clusters => "cluster search",
            Self::Search => "neighbour search",
            Self::Contacts => "contacts of particles",
            Self::Relaxation => "relaxation",
            Self::Rolling => "rolling friction",
            Self::Walls => "walls",
            Self::Clumps => "rigid clumps",
            Self::Replacement => "replacement",
            Self::Population => "inlets and outlets",
            Self::Sleep => "sleep",
            Self::BondDamping => "bond damping",
            Self::ParticleDamping => "particle damping",
            Self::Loads => "loads",
            Self::Supports => "supports",
            Self::Gravity => "gravity",
            Self::Motion => "motion",
            Self::EnergyLedger => "ledger",
            Self::Checks => "checks",
            Self::Output => "output",
        }
    }

    /// The stage in whose time its own is: it is done there, for some of the same items.
    pub fn within(self) -> Option<Self> {
        match self {
            Self::Rates | Self::Scatter => Some(Self::Failure),
            Self::Relaxation | Self::Rolling => Some(Self::Contacts),
            Self::Gravity => Some(Self::Motion),
            _ => None,
        }
    }
}

/// Times of the stages in the steps that were timed, and what they have done in all steps.
#[derive(Debug, Clone, Default)]
pub struct StageClock {
    times: [Duration; STAGES],
    done: [u64; STAGES],
    since: Option<Instant>,
}

impl StageClock {
    /// Begins a part of a step; it is timed if the step's number says so.
    pub fn start(&mut self, step: u64) {
        self.since = step.is_multiple_of(EVERY).then(Instant::now);
    }

    /// Books the time since the last call to a stage.
    pub fn book(&mut self, stage: Stage) {
        if let Some(since) = self.since {
            let now = Instant::now();
            self.times[stage as usize] += now - since;
            self.since = Some(now);
        }
    }

    /// Books a time of the whole run, not of one step in so many.
    pub fn book_all(&mut self, stage: Stage, time: Duration) {
        self.times[stage as usize] += time / EVERY as u32;
    }

    /// Books the time since then, if any, as checks: they are made in few steps, of which those that are timed are no fair sample.
    pub fn book_checks(&mut self, since: Option<Instant>) {
        if let Some(since) = since {
            self.book_all(Stage::Checks, since.elapsed());
            self.did(Stage::Checks, 1);
        }
    }

    /// Counts what a stage has just done: so many bonds, pairs, particles, bodies or looks.
    pub fn did(&mut self, stage: Stage, items: usize) {
        self.done[stage as usize] += items as u64;
    }

    /// What a stage has done so far: see [`StageClock::did`].
    pub fn done(&self, stage: Stage) -> u64 {
        self.done[stage as usize]
    }

    /// Fraction of a stage in all that was timed, 0 to 1; 0 if nothing was.
    pub fn share(&self, stage: Stage) -> f64 {
        let all: Duration = self.times.iter().sum();
        if all.is_zero() {
            0.0
        } else {
            self.times[stage as usize].as_secs_f64() / all.as_secs_f64()
        }
    }
}
