//! Parts of the summary that only some runs have: adaptive steps, bodies that break, come and go,
//! sleep.

use std::collections::BTreeMap;

use dem_physics::contact::patch_book::PatchBook;
use serde::{Deserialize, Serialize};

/// Number of bodies that are named; the others are counted.
const NAMED: usize = 3;

/// Energy error of bodies apart from all others, by themselves.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PartError {
    /// Their names: those that came near each other.
    pub bodies: Vec<String>,
    /// `fragment_id` of their first piece.
    pub fragment_id: u32,
    /// The error, J.
    pub energy_error_j: f64,
    /// Their largest energy or work, each by itself, J.
    pub energy_scale_j: f64,
    /// The error, relative to that.
    pub energy_error: f64,
}

impl PartError {
    /// The bodies in words.
    pub(super) fn named(&self) -> String {
        let first: Vec<&str> = self.bodies.iter().take(NAMED).map(String::as_str).collect();
        let others = match self.bodies.len().saturating_sub(NAMED) {
            0 => String::new(),
            others => format!(" and {others} others"),
        };
        format!(
            "'{}'{others} (piece {})",
            first.join("', '"),
            self.fragment_id
        )
    }
}

/// Range of an adaptive step.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct AdaptiveSummary {
    /// Smallest step, s.
    pub smallest_step_s: f64,
    /// Largest step, s.
    pub largest_step_s: f64,
    /// Number of its changes.
    pub changes: u64,
}

/// Bodies and fragments discharged through an outlet.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct OutletSummary {
    /// Their number.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
    /// Mass flow between the first and the last tenth of this mass, kg/s. None: too few pieces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flow_kg_s: Option<f64>,
}

/// Bodies added, removed and replaced.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PopulationSummary {
    /// Rigid clumps of two or more spheres at the end.
    pub clumps: usize,
    /// Bodies of one sphere at the end, from inlets and clumps; fragments are not counted.
    pub single_sphere_bodies: usize,
    /// Clumps that became bonded clusters.
    pub replaced: u32,
    /// Particles that daughters replaced.
    pub replaced_by_daughters: u32,
    /// Mass of fragments of these that were too small to be made, kg.
    pub fines_kg: f64,
    /// Clusters and fragments that became rigid clumps again.
    pub restored: u32,
    /// Bodies fed by inlets.
    pub fed: u32,
    /// Their mass, kg.
    pub fed_kg: f64,
    /// Bodies that had to wait for a free position.
    pub delayed: u32,
    /// Bodies that inlets have still to feed at the end.
    pub waiting: u32,
    /// Bodies and fragments discharged through outlets.
    pub discharged: u32,
    /// Their mass, kg.
    pub discharged_kg: f64,
    /// The same for each outlet, by name.
    pub outlets: BTreeMap<String, OutletSummary>,
    /// Rigid parts of bonded bodies at the end.
    pub rigid_parts: usize,
    /// Spheres that were released from rigid parts.
    pub released: u64,
    /// Spheres that joined rigid parts again.
    pub rejoined: u64,
    /// Fraction of bond updates that was skipped because bodies or parts of them were rigid.
    pub bond_updates_skipped: f64,
    /// Fraction of the spheres of a clump that nothing can touch, the mean of all templates.
    pub inner_sphere_fraction: f64,
}

impl PopulationSummary {
    /// Whether there are clumps, or bodies were added, removed or replaced; or whether nothing else
    /// was asked for.
    pub(super) fn has_changed(&self) -> bool {
        let counts = [
            self.fed,
            self.replaced,
            self.replaced_by_daughters,
            self.restored,
            self.discharged,
        ];
        counts.iter().any(|count| *count > 0)
            || self.clumps + self.single_sphere_bodies > 0
            || (self.rigid_parts == 0 && self.released == 0)
    }
}

/// Energies that decide whether daughters replace the particles of a body.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TakenIn {
    /// Largest energy over mass that one of them took in, J/kg.
    pub largest_j_kg: f64,
    /// That from which the first class of daughters replaces it, before the scatter of strengths,
    /// J/kg.
    pub needed_j_kg: f64,
}

/// What contacts have done to a wall: sums over its patches.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WallLoadSummary {
    /// Number of patches; of a plane, of those touched.
    pub patches: usize,
    /// Those that have been touched.
    pub touched: usize,
    /// The sums; the impulse along axes that turn with the wall, as at the start.
    #[serde(flatten)]
    pub sums: PatchBook,
    /// Volume worn off, m3.
    pub wear_volume_m3: f64,
    /// Largest wear depth of a patch, m.
    pub largest_wear_depth_m: f64,
}

/// A wall that moves, or whose surface does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct WallSummary {
    /// Largest distance between two places of one point of its surface, m. None: its way is not
    /// known in advance, or has no end.
    pub stroke_m: Option<f64>,
    /// Its work on the particles since the start, J.
    pub work_j: f64,
    /// The same over the time since then, W.
    pub mean_power_w: f64,
}

/// Sleeping bodies.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SleepSummary {
    /// Bodies asleep at the end.
    pub bodies: usize,
    /// Fraction of particle updates that was skipped because their bodies slept.
    pub particle_updates_skipped: f64,
}

/// Fragmentation of the bodies in a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FragmentSummary {
    /// Number of fragments, of those inside at the end and of those discharged; an intact body is
    /// one.
    pub count: usize,
    /// Number of those inside at the end.
    pub inside: usize,
    /// Mass fraction of the heaviest of all.
    pub mass_fraction_of_largest: f64,
    /// Fragments that were found in pieces.
    pub splits: usize,
}

/// Where the mass of a body is at the end of a run.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BodyFlow {
    /// Mass at the start, kg.
    pub start_kg: f64,
    /// Bodies fed by inlets.
    pub fed: u32,
    /// Their mass, kg.
    pub fed_kg: f64,
    /// Bodies and fragments discharged through each outlet, by its name, kg.
    pub discharged_kg: BTreeMap<String, f64>,
    /// Mass of the bodies and fragments inside, kg.
    pub inside_kg: f64,
    /// Mass of fragments that were too small to be made, kg.
    pub fines_kg: f64,
    /// At the start and fed, less discharged, inside and fines, kg: 0, to rounding. None: daughters
    /// of other bodies have replaced bodies, and their mass counts as that of their own body.
    pub missing_kg: Option<f64>,
}
