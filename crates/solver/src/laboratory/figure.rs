//! The numbers that a test gives.

use serde::{Deserialize, Serialize};

/// A number of a test, and its expected value.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Its name.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// SI unit; empty for plain numbers.
    pub unit: String,
    /// Expected value.
    pub theory: Option<f64>,
    /// (value - theory)/|theory|.
    pub error: Option<f64>,
}

impl Figure {
    pub(super) fn new(name: &str, value: f64, unit: &str, theory: Option<f64>) -> Self {
        Self {
            name: name.to_owned(),
            value,
            unit: unit.to_owned(),
            theory,
            error: theory.map(|theory| (value - theory) / theory.abs()),
        }
    }
}
