//! What each stage of a step takes and does: one step in `EVERY` is timed stage by stage, what is
//! written down or checked is timed always; and what a stage does is counted, so that it can be
//! shown that a stage that a scene does not need does nothing.
//!
//! Stages are known by their numbers in the table of the step.

use std::time::{Duration, Instant};

/// One step in so many is timed.
pub const EVERY: u64 = 16;

/// Most stages that there can be.
const MOST: usize = 32;

/// Times of the stages in the steps that were timed, and what they have done in all steps.
#[derive(Debug, Clone, Default)]
pub struct StageClock {
    times: [Duration; MOST],
    done: [u64; MOST],
    left_out: [bool; MOST],
    since: Option<Instant>,
}

impl StageClock {
    /// Leaves a stage out of the steps to come.
    pub fn leave_out(&mut self, stage: usize) {
        self.left_out[stage] = true;
    }

    /// Whether a stage is left out.
    pub fn is_left_out(&self, stage: usize) -> bool {
        self.left_out[stage]
    }

    /// Begins a part of a step; it is timed if the step's number says so.
    pub fn start(&mut self, step: u64) {
        self.since = step.is_multiple_of(EVERY).then(Instant::now);
    }

    /// Books the time since the last call to a stage.
    pub fn book(&mut self, stage: usize) {
        if let Some(since) = self.since {
            let now = Instant::now();
            self.times[stage] += now - since;
            self.since = Some(now);
        }
    }

    /// Books a time of the entire run, not of one step in so many: that of work which is done in
    /// few steps, of which those that are timed are no fair sample.
    pub fn book_all(&mut self, stage: usize, time: Duration) {
        self.times[stage] += time / EVERY as u32;
        self.did(stage, 1);
    }

    /// Counts what a stage has just done: so many bonds, pairs, particles, bodies or checks.
    pub fn did(&mut self, stage: usize, items: usize) {
        self.done[stage] += items as u64;
    }

    /// What a stage has done so far: see [`StageClock::did`].
    pub fn done(&self, stage: usize) -> u64 {
        self.done[stage]
    }

    /// Fraction of a stage in all that was timed, 0 to 1; 0 if nothing was.
    pub fn fraction(&self, stage: usize) -> f64 {
        let all: Duration = self.times.iter().sum();
        if all.is_zero() {
            0.0
        } else {
            self.times[stage].as_secs_f64() / all.as_secs_f64()
        }
    }
}
