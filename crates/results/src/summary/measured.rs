//! Results of measures.

use serde::{Deserialize, Serialize};

/// Result of a measure.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Measured {
    /// Its name in the scene.
    #[serde(skip_serializing)]
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// SI unit, or degrees for an angle of repose; empty for plain numbers.
    pub unit: String,
    /// Expected value.
    pub reference: Option<f64>,
    /// (value - reference) / |reference|; the plain difference if the reference is 0.
    pub error: Option<f64>,
    /// Largest relative error for the run to pass.
    pub tolerance: Option<f64>,
    /// Largest difference from the reference for the run to pass, in `unit`.
    pub absolute_tolerance: Option<f64>,
    /// Reason for a missing value. None: there is a value.
    pub missing: Option<String>,
}

impl Measured {
    /// Whether the error is within each tolerance; true without tolerances, false if it is NaN.
    pub fn is_good(&self) -> bool {
        let off = self.reference.map(|reference| self.value - reference);
        let within = |error: Option<f64>, tolerance: Option<f64>| match (error, tolerance) {
            (Some(error), Some(tolerance)) => error.abs() <= tolerance,
            _ => true,
        };
        within(self.error, self.tolerance) && within(off, self.absolute_tolerance)
    }
}
