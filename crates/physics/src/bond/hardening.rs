//! Bonds whose strengths rise with the number of their loadings.

use serde::{Deserialize, Serialize};

/// Strain beyond which a bond is loaded: less is rounding.
const LOADED: f64 = 1e-6;

/// How much the strengths of a bond rise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Hardening {
    /// Rise with each loading, over the strength at the start.
    pub per_loading: f64,
}

/// Loadings of a bond: each begins as it is pulled.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Loadings {
    /// Their number.
    pub count: u32,
    /// Whether the last one goes on.
    pub is_loaded: bool,
    /// Number of those by which its strengths have risen.
    pub applied: u32,
}

impl Hardening {
    /// Strength after this number of loadings over that at the start.
    pub fn factor(&self, loadings: u32) -> f64 {
        1.0 + self.per_loading * f64::from(loadings)
    }
}

impl Loadings {
    /// The loadings once the bond has this strain.
    pub fn at_strain(self, strain: f64) -> Self {
        let begins = !self.is_loaded && strain > LOADED;
        Self {
            count: self.count + u32::from(begins),
            is_loaded: begins || (self.is_loaded && strain > 0.0),
            ..self
        }
    }
}
