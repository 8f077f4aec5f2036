//! Bodies added, removed and replaced so far.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::clumps::Template;
use super::clusters::sizes::Discharged;

/// Progress of replacement, inlets and outlets.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Population {
    /// Progress of each inlet. Length as [`super::rules::Rules::inlets`].
    pub inlets: Vec<InletProgress>,
    /// Totals of each outlet. Length as [`super::rules::Rules::outlets`].
    pub outlets: Vec<OutletTotals>,
    /// Shapes of fragments that became clumps. Their numbers follow those of the model's templates.
    pub fragments: Vec<FragmentTemplate>,
    /// Numbers of the templates of single spheres that came as daughters, by the template of the
    /// scene that they come from and the bits of their radius.
    pub daughter_spheres: BTreeMap<(u32, u64), u32>,
    /// For each template of the scene, its particles that daughters replaced.
    pub by_daughters: Vec<u32>,
    /// For each template of the scene, the mass of fragments that were too small to be made, kg.
    pub fines_kg: Vec<f64>,
    /// For each cluster that was a clump, the template of the scene that it comes from, and its
    /// [instance](super::clumps::Clump::instance).
    pub base_of_cluster: BTreeMap<u32, (u32, u32)>,
    /// The next [id](super::particles::Particles::id) of a particle.
    pub next_particle_id: u32,
    /// What has left through outlets, in order.
    pub discharged: Vec<Discharged>,
    /// For each body of the model its broken bonds that have left with it, or that are within
    /// pieces that are rigid again. Empty: none.
    pub broken_gone: Vec<u64>,
    /// Bodies that came through inlets.
    pub instances: u32,
    /// Clumps that became clusters.
    pub replaced: u32,
    /// Clusters that became clumps again.
    pub restored: u32,
    /// Bond updates done, and those skipped because bodies were rigid.
    pub bond_steps: [u64; 2],
}

/// The shape of a fragment.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FragmentTemplate {
    /// The template of the scene that it comes from.
    pub base: u32,
    /// Its own template.
    pub template: Arc<Template>,
}

/// Progress of an inlet.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct InletProgress {
    /// Number of bodies fed.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
    /// Positions tried for the next body that were occupied.
    pub tries: u32,
    /// Step of the next attempt.
    pub next_try: u64,
    /// Bodies that had to wait for a free position.
    pub delayed: u32,
}

/// What is near the region of an inlet, from one look to the next.
#[derive(Debug, Clone, Default)]
pub struct Surroundings {
    /// Particles.
    pub particles: Vec<u32>,
    /// Clumps.
    pub clumps: Vec<u32>,
    /// Distance that everything may still move, m, before something else may be in the way. 0 or
    /// less: this is to be found again.
    pub left_m: f64,
}

/// The clusters that may reach an outlet before the others.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct OutletWatch {
    /// Their numbers, ascending.
    pub near: Vec<u32>,
    /// Number of clusters, present or former, that have been looked at.
    pub known: u32,
    /// Distance that everything may still move, m, before another one may be there.
    pub left_m: f64,
}

/// What an outlet has removed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct OutletTotals {
    /// Number of bodies and fragments.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
}
