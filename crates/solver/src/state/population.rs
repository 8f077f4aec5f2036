//! Bodies that came, went and became others so far.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::clumps::Template;

/// How far replacement, inlets and outlets have come.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Population {
    /// For each inlet what has come through it. Length as [`super::rules::Rules::inlets`].
    pub inlets: Vec<InletProgress>,
    /// For each outlet what has left through it. Length as [`super::rules::Rules::outlets`].
    pub outlets: Vec<OutletTotals>,
    /// Shapes of fragments that became clumps. Their numbers follow those of the model's templates.
    pub fragments: Vec<FragmentTemplate>,
    /// For each cluster that was a clump, the template of the scene that it comes from, and its
    /// [instance](super::clumps::Clump::instance).
    pub base_of_cluster: BTreeMap<u32, (u32, u32)>,
    /// Bodies that came through inlets.
    pub instances: u32,
    /// Clumps that became clusters.
    pub replaced: u32,
    /// Clusters that became clumps again.
    pub restored: u32,
    /// Bonds that were there times steps, and those that were left out because their bodies were
    /// clumps.
    pub bond_steps: [u64; 2],
}

/// The shape of a fragment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FragmentTemplate {
    /// The template of the scene that it comes from.
    pub base: u32,
    /// Its own.
    pub template: Arc<Template>,
}

/// How far an inlet has come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct InletProgress {
    /// Bodies that have come.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
    /// Places that were looked at for the next body and were taken.
    pub tries: u32,
    /// Step at which a place is looked for again.
    pub next_try: u64,
    /// Bodies that had to wait for a place.
    pub delayed: u32,
}

/// What an outlet has removed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct OutletTotals {
    /// Bodies and fragments.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
}
