//! Sizes of the fragments.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Smallest fragments of which the material decides and not the size of the spheres, in mean
/// diameters of the spheres.
pub const RESOLVED_DIAMETERS: f64 = 3.0;

/// Which figures lie below the size that the spheres resolve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Unresolved {
    /// `d10_m`
    pub d10: bool,
    /// `d50_m`
    pub d50: bool,
    /// `d80_m`
    pub d80: bool,
    /// `t10`
    pub t10: bool,
}

impl Unresolved {
    /// Their names.
    pub fn names(self) -> Vec<&'static str> {
        let all = [
            ("d10", self.d10),
            ("d50", self.d50),
            ("d80", self.d80),
            ("t10", self.t10),
        ];
        let own = all.into_iter().filter(|(_, is_unresolved)| *is_unresolved);
        own.map(|(name, _)| name).collect()
    }
}

/// Mass, sizes and fines of some fragments.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SizeSummary {
    /// Mass of the fragments, kg.
    pub mass_kg: f64,
    /// Size up to which a tenth of the mass is, m: that of the first fragment, from the smallest,
    /// with which the sum reaches a tenth.
    pub d10_m: f64,
    /// The same for half of the mass, m.
    pub d50_m: f64,
    /// The same for 80 % of the mass, m.
    pub d80_m: f64,
    /// Mass fraction smaller than a tenth of the mean size of the bodies before they broke. None:
    /// no sphere is as small, so that it could only be 0.
    pub t10: Option<f64>,
    /// Three mean diameters of the spheres, m: below, the spheres decide and not the material.
    pub resolved_from_m: f64,
    /// Those of these figures that lie below that size.
    pub unresolved: Unresolved,
}

/// Size distributions at the end of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Sizes {
    /// Of all bodies together: fragments `inside`, `discharged` ones, and `both`.
    pub all: BTreeMap<String, SizeSummary>,
    /// The same for each body.
    pub bodies: BTreeMap<String, BTreeMap<String, SizeSummary>>,
}
