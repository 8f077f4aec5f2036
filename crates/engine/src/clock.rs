//! Time and work of each stage of a step. One step in `EVERY` is timed stage by stage, and counts
//! as many times; output, checks and stages that have work in few steps only are always timed. The
//! work of stages is counted, to show that a stage that a scene does not need does nothing.
//!
//! Stages are identified by their numbers in the table of the step.

use std::time::{Duration, Instant};

/// One step in this many is timed.
pub(crate) const EVERY: u64 = 16;

/// What is known of a stage.
#[derive(Debug, Clone, Default)]
struct Timed {
    time: Duration,
    done: u64,
    is_left_out: bool,
}

/// Times of the stages in all steps, as far as is known from the timed ones, and their work.
#[derive(Debug, Clone, Default)]
pub struct StageClock {
    /// By number, up to the largest number used.
    stages: Vec<Timed>,
    since: Option<Instant>,
}

impl StageClock {
    fn stage(&mut self, number: usize) -> &mut Timed {
        if number >= self.stages.len() {
            self.stages.resize_with(number + 1, Timed::default);
        }
        &mut self.stages[number]
    }

    /// Skips a stage in all following steps.
    pub fn leave_out(&mut self, stage: usize) {
        self.stage(stage).is_left_out = true;
    }

    /// Whether a stage is skipped.
    pub fn is_left_out(&self, stage: usize) -> bool {
        self.stages.get(stage).is_some_and(|one| one.is_left_out)
    }

    /// Begins a part of a step; the step's number decides whether it is timed.
    pub fn start(&mut self, step: u64) {
        self.since = step.is_multiple_of(EVERY).then(Instant::now);
    }

    /// Adds the time since the last call to a stage.
    pub(crate) fn book(&mut self, stage: usize) {
        if let Some(since) = self.since {
            let now = Instant::now();
            self.stage(stage).time += (now - since) * EVERY as u32;
            self.since = Some(now);
        }
    }

    /// Adds the time since `began` to a stage, whether or not this step is timed: for work done in
    /// few steps, of which the timed ones are not a representative sample.
    pub fn book_since(&mut self, stage: usize, began: Instant) {
        let now = Instant::now();
        self.stage(stage).time += now - began;
        self.since = self.since.map(|_| now);
    }

    /// Counts the work that a stage has just done: bonds, pairs, particles, bodies or checks.
    pub fn did(&mut self, stage: usize, items: usize) {
        self.stage(stage).done += items as u64;
    }

    /// Work of a stage so far: see [`StageClock::did`].
    pub fn done(&self, stage: usize) -> u64 {
        self.stages.get(stage).map_or(0, |one| one.done)
    }

    /// Fraction of a stage in all timed work, 0 to 1; 0 if nothing was timed.
    pub fn fraction(&self, stage: usize) -> f64 {
        let all: Duration = self.stages.iter().map(|one| one.time).sum();
        match self.stages.get(stage) {
            Some(one) if !all.is_zero() => one.time.as_secs_f64() / all.as_secs_f64(),
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_is_room_for_any_number_of_stages() {
        let mut clock = StageClock::default();
        clock.did(1000, 3);
        clock.leave_out(2000);
        assert_eq!([clock.done(1000), clock.done(3000)], [3, 0]);
        assert_eq!(
            [1000, 2000, 3000].map(|n| clock.is_left_out(n)),
            [false, true, false]
        );
    }

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
