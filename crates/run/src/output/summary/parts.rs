//! Parts of the summary that only some runs have: adaptive steps, bodies that come and go, sleep.

use std::collections::{BTreeMap, BTreeSet};

use serde::Serialize;

use dem_engine::stages::ledger::over;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::sleep::Sleep;

/// Number of bodies that are named; the others are counted.
const NAMED: usize = 3;

/// Energy error of bodies apart from all others, by themselves.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
    /// The largest of a state, if it is more than this relative error of the whole.
    pub(crate) fn above(energy_error: f64, state: &State) -> Option<Self> {
        let largest = state.contacts.as_ref()?.islands.largest()?;
        (largest.ratio() > energy_error).then(|| Self {
            bodies: (largest.bodies.iter())
                .map(|body| state.model.body_name(*body).to_owned())
                .collect(),
            fragment_id: largest.piece,
            energy_error_j: largest.error_j,
            energy_scale_j: largest.scale_j,
            energy_error: largest.ratio(),
        })
    }

    /// The bodies in words.
    pub(crate) fn named(&self) -> String {
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
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AdaptiveSummary {
    /// Smallest step, s.
    pub smallest_step_s: f64,
    /// Largest step, s.
    pub largest_step_s: f64,
    /// Number of its changes.
    pub changes: u64,
}

/// Bodies and fragments discharged through an outlet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct OutletSummary {
    /// Their number.
    pub bodies: u32,
    /// Their mass, kg.
    pub mass_kg: f64,
}

/// Bodies added, removed and replaced.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PopulationSummary {
    /// Rigid clumps of two or more spheres at the end.
    pub clumps: usize,
    /// Bodies of one sphere at the end, from inlets and clumps; fragments are not counted.
    pub single_sphere_bodies: usize,
    /// Clumps that became bonded clusters.
    pub replaced: u32,
    /// Particles that daughters replaced.
    pub replaced_by_daughters: u32,
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

    /// From a state at its end. None: no body can be added, removed or replaced, or is rigid in
    /// part.
    pub fn of(state: &State, bodies: &[PlacedBody]) -> Option<Self> {
        let (rules, clumps) = (&state.model.rules, &state.clumps);
        let population = &state.population;
        if !state.bodies_change() && rules.zones.is_empty() {
            return None;
        }
        let several = clumps.of_several_spheres();
        let [done, left_out] = population.bond_steps.map(|count| count as f64);
        let inner = clumps.templates.iter();
        let inner: f64 = inner
            .map(|t| 1.0 - t.outer.len() as f64 / t.spheres.len() as f64)
            .sum();
        Some(Self {
            clumps: several,
            single_sphere_bodies: clumps.all.len() - several + single_spheres(state, bodies),
            replaced: population.replaced,
            replaced_by_daughters: population.by_daughters.iter().sum(),
            restored: population.restored,
            fed: population.inlets.iter().map(|come| come.bodies).sum(),
            fed_kg: (population.inlets.iter()).fold(0.0, |sum, come| sum + come.mass_kg),
            delayed: population.inlets.iter().map(|come| come.delayed).sum(),
            waiting: (rules.inlets.iter().zip(&population.inlets))
                // Bodies that are due at the very end have not been tried.
                .map(|(inlet, come)| inlet.owed(come, state.time_s - state.time_step_s))
                .sum(),
            discharged: population.outlets.iter().map(|left| left.bodies).sum(),
            discharged_kg: (population.outlets.iter()).fold(0.0, |sum, left| sum + left.mass_kg),
            outlets: (rules.outlets.iter().zip(&population.outlets))
                .map(|(outlet, left)| {
                    let (bodies, mass_kg) = (left.bodies, left.mass_kg);
                    (outlet.name.clone(), OutletSummary { bodies, mass_kg })
                })
                .collect(),
            rigid_parts: state.rigid_parts.all.len(),
            released: state.rigid_parts.released,
            rejoined: state.rigid_parts.rejoined,
            bond_updates_skipped: over(left_out, done + left_out),
            inner_sphere_fraction: over(inner, clumps.templates.len() as f64),
        })
    }
}

/// Bodies of one sphere that are particles and come from inlets or clumps.
fn single_spheres(state: &State, bodies: &[PlacedBody]) -> usize {
    let templates = state.clumps.templates.iter().zip(&state.model.rules.starts);
    let names: BTreeSet<&str> = templates
        .filter(|(_, start)| start.sphere)
        .map(|(template, _)| &template.body[..])
        .collect();
    let is_one = |body: &&PlacedBody| names.contains(&body.name[..]);
    bodies.iter().filter(is_one).count()
}

/// Energies that decide whether daughters replace the particles of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TakenIn {
    /// Largest energy over mass that one of them took in, J/kg.
    pub largest_j_kg: f64,
    /// That from which the first class of daughters replaces it, before the scatter of strengths,
    /// J/kg.
    pub needed_j_kg: f64,
}

/// Sleeping bodies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SleepSummary {
    /// Bodies asleep at the end.
    pub bodies: usize,
    /// Fraction of particle updates that was skipped because their bodies slept.
    pub particle_updates_skipped: f64,
}

impl SleepSummary {
    /// From the data at the end.
    pub fn of(sleep: &Sleep) -> Self {
        let [done, left_out] = sleep.particle_steps.map(|count| count as f64);
        Self {
            bodies: sleep.bodies,
            particle_updates_skipped: over(left_out, done + left_out),
        }
    }
}
