//! Triggers of the search for clusters (Platzer 2022, section 4.2.3 and algorithm 3).

use serde::{Deserialize, Serialize};

/// Triggers of the search for clusters: at regular intervals, if enough bonds have broken, or if
/// any has and a forced search is due.
///
/// The four triggers of Platzer 2022, section 4.2.3, are settings of these numbers: see the
/// functions that make them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Triggers {
    /// Steps between checks; 0 is the same as 1.
    pub interval: u64,
    /// Bonds that must have broken since the last search.
    pub min_broken: u64,
    /// Interval, in checks, at which one broken bond is enough; 0: never.
    pub force_every: u64,
}

impl Default for Triggers {
    /// Every 50 steps, if any bond has broken.
    fn default() -> Self {
        Self::at_interval(50)
    }
}

impl Triggers {
    /// The first: in every step in which a bond has broken.
    pub fn every_step() -> Self {
        Self::at_interval(1)
    }

    /// The second: as soon as more than this number of bonds have broken.
    pub fn after_more_than(broken: u64) -> Self {
        Self::combined(1, broken, 0)
    }

    /// The third: at regular intervals, if any bond has broken.
    pub fn at_interval(interval: u64) -> Self {
        Self::combined(interval, 0, 0)
    }

    /// The fourth: at regular intervals, if more than this number of bonds have broken, and at
    /// every `force_every`-th check if any has.
    pub fn combined(interval: u64, broken: u64, force_every: u64) -> Self {
        Self {
            interval,
            min_broken: broken + 1,
            force_every,
        }
    }

    /// Whether to search after this step, with this number of bonds broken since the last search.
    pub fn due(&self, step: u64, broken_since: u64) -> bool {
        let interval = self.interval.max(1);
        if broken_since == 0 || !step.is_multiple_of(interval) {
            return false;
        }
        let is_forced = self.force_every > 0 && (step / interval).is_multiple_of(self.force_every);
        broken_since >= self.min_broken || is_forced
    }
}
