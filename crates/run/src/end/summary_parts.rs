//! Parts of the summary, from the state at the end of a run.

use std::collections::{BTreeMap, BTreeSet};

use dem_scene::Scene;

use dem_engine::stages::ledger::bookkeeping::over;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::clusters::sizes::Discharged;
use dem_engine::state::sleep::Sleep;
use dem_engine::state::walls::Wall;
use dem_plan::stroke_m;
use dem_results::summary::{
    OutletSummary, PartError, PopulationSummary, SleepSummary, WallSummary,
};

/// Share of the mass of an outlet at either end that its flow leaves out.
const TENTH: f64 = 0.1;
/// Mass over that of a body that an inlet feeds below which an outlet has no flow: a few bodies
/// come in bursts, in whatever many pieces.
const ENOUGH_FOR_A_FLOW: f64 = 20.0;

/// The largest energy error of bodies apart from all others, if it is more than this relative error
/// of the whole.
pub(crate) fn part_error_above(energy_error: f64, state: &State) -> Option<PartError> {
    let largest = state.contacts.as_ref()?.islands.largest()?;
    (largest.ratio() > energy_error).then(|| PartError {
        bodies: (largest.bodies.iter())
            .map(|body| state.model.body_name(*body).to_owned())
            .collect(),
        fragment_id: largest.piece,
        energy_error_j: largest.error_j,
        energy_scale_j: largest.scale_j,
        energy_error: largest.ratio(),
    })
}

/// Bodies added, removed and replaced by the end of a run. None: no body can be added, removed or
/// replaced, or is rigid in part.
pub(crate) fn population_summary(
    state: &State,
    bodies: &[PlacedBody],
) -> Option<PopulationSummary> {
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
    let fed: u32 = population.inlets.iter().map(|come| come.bodies).sum();
    let fed_kg = (population.inlets.iter()).fold(0.0, |sum, come| sum + come.mass_kg);
    Some(PopulationSummary {
        clumps: several,
        single_sphere_bodies: clumps.all.len() - several + single_spheres(state, bodies),
        replaced: population.replaced,
        replaced_by_daughters: population.by_daughters.iter().sum(),
        fines_kg: population.fines_kg.iter().fold(0.0, |sum, kg| sum + kg),
        restored: population.restored,
        fed,
        fed_kg,
        delayed: population.inlets.iter().map(|come| come.delayed).sum(),
        waiting: (rules.inlets.iter().zip(&population.inlets))
            // Bodies that are due at the very end have not been tried.
            .map(|(inlet, come)| inlet.owed(come, state.time_s - state.time_step_s))
            .sum(),
        discharged: population.outlets.iter().map(|left| left.bodies).sum(),
        discharged_kg: (population.outlets.iter()).fold(0.0, |sum, left| sum + left.mass_kg),
        outlets: (rules.outlets.iter().zip(&population.outlets))
            .enumerate()
            .map(|(number, (outlet, left))| {
                let summary = OutletSummary {
                    bodies: left.bodies,
                    mass_kg: left.mass_kg,
                    flow_kg_s: flow_kg_s(&population.discharged, number)
                        .filter(|_| left.mass_kg >= ENOUGH_FOR_A_FLOW * fed_kg / f64::from(fed)),
                };
                (outlet.name.clone(), summary)
            })
            .collect(),
        rigid_parts: state.rigid_parts.all.len(),
        released: state.rigid_parts.released,
        rejoined: state.rigid_parts.rejoined,
        bond_updates_skipped: over(left_out, done + left_out),
        inner_sphere_fraction: over(inner, clumps.templates.len() as f64),
    })
}

/// Mass flow through an outlet between the first and the last tenth of the mass that it took, kg/s.
/// None: it took nothing, or all at once.
fn flow_kg_s(discharged: &[Discharged], outlet: usize) -> Option<f64> {
    let own = discharged
        .iter()
        .filter(|one| one.outlet as usize == outlet);
    let left: Vec<[f64; 2]> = own.map(|one| [one.time_s, one.size.mass_kg]).collect();
    let all_kg: f64 = left.iter().map(|[_, mass_kg]| mass_kg).sum();
    let mut sum_kg = 0.0;
    let mut sums = left.iter().map(|[time_s, mass_kg]| {
        sum_kg += mass_kg;
        [*time_s, sum_kg]
    });
    let [from_s, from_kg] = sums.find(|[_, sum_kg]| *sum_kg >= TENTH * all_kg)?;
    let [to_s, to_kg] = sums.find(|[_, sum_kg]| *sum_kg >= (1.0 - TENTH) * all_kg)?;
    (to_s > from_s).then(|| (to_kg - from_kg) / (to_s - from_s))
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

/// Walls that move, or whose surfaces do, by name; none of a laboratory test.
pub(crate) fn wall_summaries(scene: &Scene, state: &State) -> BTreeMap<String, WallSummary> {
    let is_asked = |wall: &&Wall| scene.test.is_none() && wall.does_work();
    let summary = |wall: &Wall| WallSummary {
        stroke_m: stroke_m(wall, state.time_s),
        work_j: wall.work_j,
        mean_power_w: over(wall.work_j, state.time_s),
    };
    let moving = state.walls.iter().filter(is_asked);
    moving
        .map(|wall| (wall.model.name.clone(), summary(wall)))
        .collect()
}

/// Sleeping bodies at the end.
pub(crate) fn sleep_summary(sleep: &Sleep) -> SleepSummary {
    let [done, left_out] = sleep.particle_steps.map(|count| count as f64);
    SleepSummary {
        bodies: sleep.bodies,
        particle_updates_skipped: over(left_out, done + left_out),
    }
}
