//! What measures follow in every step: forces, and the contacts between two.

use dem_scene::Quantity;
use serde::{Deserialize, Serialize};

/// A measure that is read in every step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Watch {
    /// What it is of.
    pub quantity: Quantity,
    /// Whose forces and contacts.
    pub of: WatchTarget,
    /// What it has seen.
    pub seen: Seen,
}

/// Whose forces and contacts are followed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum WatchTarget {
    /// A wall, by number, with all that touches it.
    Wall(usize),
    /// Particles, for each of the state whether it is one of them, with all else.
    Particles(Vec<bool>),
    /// Particles with a wall, by number.
    WithWall(Vec<bool>, usize),
    /// Particles of the first with those of the second.
    Between([Vec<bool>; 2]),
}

/// What has been seen so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// The present value, in the unit of the quantity.
    pub value: f64,
    /// All values.
    pub history: History,
    /// Deepest overlap in the step before, m; below 0 by the distance of what is apart. None: there
    /// was no step.
    pub overlap_m: Option<f64>,
    /// How long the two have touched, s.
    pub touched_s: f64,
}

/// What a measure has shown so far. Values that are no numbers count as the last value alone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct History {
    /// Time, s, and value.
    pub last: Option<(f64, f64)>,
    /// The largest value.
    pub largest: Option<f64>,
    /// The smallest value.
    pub smallest: Option<f64>,
    /// Integral over time.
    pub integral: f64,
    /// Time that the integral is over, s.
    pub duration_s: f64,
}

impl History {
    /// Takes down the value at a time, s.
    pub fn note(&mut self, time_s: f64, value: f64) {
        if let Some((before_s, before)) = self.last
            && !(before.is_nan() || value.is_nan())
        {
            self.integral += 0.5 * (value + before) * (time_s - before_s);
            self.duration_s += time_s - before_s;
        }
        self.last = Some((time_s, value));
        if !value.is_nan() {
            self.largest = Some(self.largest.map_or(value, |l| l.max(value)));
            self.smallest = Some(self.smallest.map_or(value, |s| s.min(value)));
        }
    }
}

impl WatchTarget {
    /// Bytes of its arrays.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Wall(_) => 0,
            Self::Particles(of) | Self::WithWall(of, _) => of.len(),
            Self::Between([of, with]) => of.len() + with.len(),
        }
    }
}
