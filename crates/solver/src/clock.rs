//! Where the time of a run goes: one step in `EVERY` is timed stage by stage; what is written down is timed always.

use std::time::{Duration, Instant};

/// One step in so many is timed.
pub const EVERY: u64 = 16;

/// What is timed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Forces of bonds.
    Bonds,
    /// Contacts, and the search for them.
    Contacts,
    /// The search for pieces.
    Clusters,
    /// Damping of bonds and particles.
    Damping,
    /// Loads, supports, breakage and the ledger.
    Rest,
    /// Kick and drift.
    Motion,
    /// Triggers, replacement, inlets and outlets.
    Replacement,
    /// Measures, checks, files and pictures.
    Output,
}

impl Stage {
    /// All, in the order of the table.
    pub const ALL: [Self; 8] = [
        Self::Bonds,
        Self::Contacts,
        Self::Clusters,
        Self::Damping,
        Self::Motion,
        Self::Replacement,
        Self::Rest,
        Self::Output,
    ];

    /// For a person.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bonds => "bonds",
            Self::Contacts => "contacts",
            Self::Clusters => "clusters",
            Self::Damping => "damping",
            Self::Rest => "rest",
            Self::Motion => "motion",
            Self::Replacement => "replacement",
            Self::Output => "output",
        }
    }
}

/// Times of the stages in the steps that were timed.
#[derive(Debug, Clone, Default)]
pub struct StageClock {
    times: [Duration; 8],
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

    /// Books a time of the whole run, not of one step in so many, as output.
    pub fn book_output(&mut self, time: Duration) {
        self.times[Stage::Output as usize] += time / EVERY as u32;
    }

    /// Share of a stage in all that was timed, 0 to 1; 0 if nothing was.
    pub fn share(&self, stage: Stage) -> f64 {
        let all: Duration = self.times.iter().sum();
        if all.is_zero() {
            0.0
        } else {
            self.times[stage as usize].as_secs_f64() / all.as_secs_f64()
        }
    }
}
