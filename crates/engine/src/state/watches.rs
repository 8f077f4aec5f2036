//! Quantities that measures record in every step: forces, and contacts between two objects.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// A measure that is evaluated in every step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Watch {
    /// The quantity.
    pub quantity: Recorded,
    /// The part of the force that it records: see [`part`].
    pub part: usize,
    /// The object whose forces and contacts it records.
    pub of: WatchTarget,
    /// The record.
    pub seen: Seen,
}

/// Quantities that are recorded in every step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Recorded {
    /// Force of the contacts, N.
    Force,
    /// Deepest overlap of the contacts, m; 0 if there is none.
    Overlap,
    /// Total time of contact, s.
    Duration,
}

/// Number of the magnitude among the parts of a vector: see [`part`].
pub const MAGNITUDE: usize = 3;

/// The component of a vector along the axis 0, 1 or 2, or, for [`MAGNITUDE`], its magnitude.
pub fn part(vector: &Vector3<f64>, number: usize) -> f64 {
    match vector.get(number) {
        Some(component) => *component,
        None => vector.norm(),
    }
}

/// Objects whose forces and contacts are recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum WatchTarget {
    /// A wall, by number, with everything that touches it.
    Wall(usize),
    /// Particles (a flag for each particle of the state), with everything else.
    Particles(Vec<bool>),
    /// Particles with a wall, by number.
    WithWall(Vec<bool>, usize),
    /// Particles of the first with those of the second.
    Between([Vec<bool>; 2]),
}

/// The record so far.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// The present value, in the unit of the quantity.
    pub value: f64,
    /// All values.
    pub history: History,
    /// Deepest overlap in the previous step, m; for separate objects, minus their distance. None:
    /// there was no step.
    pub overlap_m: Option<f64>,
    /// Total time of contact, s.
    pub touched_s: f64,
}

/// Statistics of a measure so far. Values that are not numbers only count as the last value.
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
    /// Duration of the integral, s.
    pub duration_s: f64,
    /// Of a mixing index, how far it may be off: the last value, and any so far.
    pub index_errors: [IndexError; 2],
}

/// How far a mixing index may be off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct IndexError {
    /// Standard error, as cells hold a limited number of pieces.
    pub standard: f64,
    /// What the index is too large by, as its two sets lie apart within cells: at least a third of
    /// it. All of the index if cells hold too few pieces to tell.
    pub within_cells: f64,
}

impl IndexError {
    /// Both parts together.
    pub fn sum(&self) -> f64 {
        self.standard + self.within_cells
    }
}

impl History {
    /// Records the value at a time, s.
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

    /// Records how far the present value of a mixing index may be off.
    pub fn note_error(&mut self, error: IndexError) {
        let [last, largest] = &mut self.index_errors;
        *last = error;
        if error.sum() > largest.sum() {
            *largest = error;
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
