//! What is varied, and what it is to give.

use serde::{Deserialize, Serialize};

/// A number of the scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Number {
    /// Its path, as in `bonds.cake.young_modulus`.
    pub path: String,
    /// Its value in the scene, in `unit`; above 0.
    pub value: f64,
    /// Its unit as written; empty for a plain number.
    pub unit: String,
}

/// Numbers of a scene that are multiplied by one factor, and the result that they determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// The numbers; at least one.
    pub numbers: Vec<Number>,
    /// Name of the result.
    pub result: String,
    /// SI unit of the result; empty for plain numbers.
    pub unit: String,
    /// Wanted result; above 0.
    pub target: f64,
    /// Largest relative deviation of the mean result from the target.
    pub tolerance: f64,
    /// True if the result is nearly proportional to the numbers, as modulus and strength of a body
    /// are to those of its bonds.
    pub is_proportional: bool,
}

impl Number {
    /// The number times a factor, rounded to six digits, as tests take it and files state it.
    pub fn times(&self, factor: f64) -> f64 {
        let value = self.value * factor;
        // What `format!` has written is a number.
        format!("{value:.5e}").parse().unwrap_or(value)
    }

    /// The value of [`Self::times`] with its unit.
    pub fn text(&self, factor: f64) -> String {
        format!("{} {}", self.times(factor), self.unit)
            .trim_end()
            .to_owned()
    }
}
