//! Time and work of each stage of a step. One step in `EVERY` is timed stage by stage, and counts
//! as many times; output, checks and stages that have work in few steps only are always timed. The
//! work of stages is counted, to show that a stage that a scene does not need does nothing.
//!
//! Stages are identified by their numbers in the table of the step.

use std::time::{Duration, Instant};

/// One step in this many is timed.
pub(crate) const EVERY: u64 = 16;

/// Largest number of stages.
const MOST: usize = 40;

/// Times of the stages in all steps, as far as is known from the timed ones, and their work.
#[derive(Debug, Clone)]
pub struct StageClock {
    times: [Duration; MOST],
    done: [u64; MOST],
    left_out: [bool; MOST],
    since: Option<Instant>,
}

impl Default for StageClock {
    fn default() -> Self {
        Self {
            times: [Duration::ZERO; MOST],
            done: [0; MOST],
            left_out: [false; MOST],
            since: None,
        }
    }
}

impl StageClock {
    /// Skips a stage in all following steps.
    pub fn leave_out(&mut self, stage: usize) {
        self.left_out[stage] = true;
    }

    /// Whether a stage is skipped.
    pub fn is_left_out(&self, stage: usize) -> bool {
        self.left_out[stage]
    }

    /// Begins a part of a step; the step's number decides whether it is timed.
    pub fn start(&mut self, step: u64) {
        self.since = step.is_multiple_of(EVERY).then(Instant::now);
    }

    /// Adds the time since the last call to a stage.
    pub(crate) fn book(&mut self, stage: usize) {
        if let Some(since) = self.since {
            let now = Instant::now();
            self.times[stage] += (now - since) * EVERY as u32;
            self.since = Some(now);
        }
    }

    /// Adds the time since `began` to a stage, whether or not this step is timed: for work done in
    /// few steps, of which the timed ones are not a representative sample.
    pub(crate) fn book_since(&mut self, stage: usize, began: Instant) {
        let now = Instant::now();
        self.times[stage] += now - began;
        self.since = self.since.map(|_| now);
    }

    /// Counts the work that a stage has just done: bonds, pairs, particles, bodies or checks.
    pub fn did(&mut self, stage: usize, items: usize) {
        self.done[stage] += items as u64;
    }

    /// Work of a stage so far: see [`StageClock::did`].
    pub fn done(&self, stage: usize) -> u64 {
        self.done[stage]
    }

    /// Fraction of a stage in all timed work, 0 to 1; 0 if nothing was timed.
    pub fn fraction(&self, stage: usize) -> f64 {
        let all: Duration = self.times.iter().sum();
        if all.is_zero() {
            0.0
        } else {
            self.times[stage].as_secs_f64() / all.as_secs_f64()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_with_work_in_few_steps_is_timed_in_each() {
        let mut clock = StageClock::default();
        let began = Instant::now();
        std::thread::sleep(Duration::from_millis(1));
        clock.start(EVERY + 1);
        clock.book(0);
        clock.book_since(1, began);
        clock.book(2);
        assert_eq!(
            [0, 1, 2].map(|stage| clock.fraction(stage)),
            [0.0, 1.0, 0.0]
        );
        // In a step that is timed, the next stage begins where this one ended.
        clock.start(EVERY);
        std::thread::sleep(Duration::from_millis(1));
        let before = Instant::now();
        clock.book_since(1, began);
        assert!(clock.since >= Some(before));
    }
}
