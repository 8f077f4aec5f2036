//! Clumps that become bonded clusters (BPRM: Platzer 2022, section 4.5.4).

use nalgebra::Vector3;

use super::contact_stress::find_squeezes;
use crate::stages::population::change::apply_topology_change;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::clump_stress::Squeeze;
use crate::state::clumps::Clump;
use crate::state::events::TopologyChange;
use crate::state::events::{PopulationEvent, STARTS_BONDED};
use crate::state::rules::Trigger;

/// Clumps that become clusters, and clusters that become clumps.
pub(crate) const REPLACEMENT: Stage = Stage::new("replacement", |state, _| {
    let rules = &state.model.rules;
    let replaces = rules.triggers.iter().any(Option::is_some);
    let mut starts = rules.starts.iter();
    let starts = !rules.are_none() && starts.any(|start| start.bonded || start.sphere);
    Need::of(
        starts || replaces,
        || {
            let of_starts = "new bodies start as bonded clusters or single spheres";
            let text = if replaces {
                "clumps become bonded clusters"
            } else {
                of_starts
            };
            text.to_owned()
        },
        "no clump can become a cluster",
    )
});

/// Contacts that triggers by single forces or stress read.
pub(crate) const SQUEEZE: Stage = Stage {
    within: Some(REPLACEMENT.name),
    ..Stage::new("squeeze of clumps", |state, _| {
        let mut triggers = state.model.rules.triggers.iter().flatten();
        Need::of(
            state.contacts.is_some() && triggers.any(|trigger| trigger.needs_squeeze()),
            || "a trigger reads the forces of single contacts".to_owned(),
            "no trigger reads the forces of single contacts",
        )
    })
};

/// The conditions of a trigger, in the order in which they are asked.
const CAUSES: [&str; 6] = [
    "enters",
    "force",
    "contact_force",
    "principal_stress",
    "impact_energy",
    "time",
];

/// The number of contacts that triggers have read in this step.
pub(crate) fn count_squeezing(state: &mut State) -> usize {
    std::mem::take(&mut state.scratch.squeezing)
}

/// Replaces the clumps whose trigger has fired, between a kick and the drift after it. Returns the
/// number of clumps checked.
pub(crate) fn replace_clumps(state: &mut State) -> usize {
    if state.model.rules.are_none() {
        return 0;
    }
    let clumps = state.clumps.all.len();
    let due = all_triggered(state);
    let (to_clusters, causes): (Vec<usize>, Vec<&'static str>) = due.into_iter().unzip();
    if !to_clusters.is_empty() {
        swap(state, to_clusters, &causes);
    }
    let can_fire = state.model.rules.triggers.iter().any(Option::is_some);
    if can_fire { clumps } else { 0 }
}

/// Clumps whose trigger fires: their numbers and the causes.
fn all_triggered(state: &mut State) -> Vec<(usize, &'static str)> {
    let mut squeezes = std::mem::take(&mut state.scratch.squeezes);
    state.scratch.squeezing += find_squeezes(state, &mut squeezes);
    let found = triggered(state, &squeezes).collect();
    state.scratch.squeezes = squeezes;
    found
}

/// Clumps that become clusters: their numbers and the causes.
fn triggered(state: &State, squeezes: &[Squeeze]) -> impl Iterator<Item = (usize, &'static str)> {
    let rules = &state.model.rules;
    (state.clumps.all.iter().enumerate()).filter_map(move |(n, clump)| {
        let template = clump.template as usize;
        let start = rules.starts.get(template);
        if start.is_some_and(|start| start.bonded || start.sphere) {
            return Some((n, STARTS_BONDED));
        }
        let squeeze = squeezes.get(n);
        let cause = match rules.triggers.get(template) {
            Some(trigger) => met(trigger.as_ref()?, clump, squeeze, state)?,
            None => {
                let base = state.base_of(clump.template) as usize;
                met(&rules.trigger_of_fragment(base)?, clump, squeeze, state)?
            }
        };
        Some((n, cause))
    })
}

/// The condition of a trigger that a clump meets, or the first one if it needs all and meets all.
/// `squeeze`: None if no trigger needs it, or nothing can touch.
fn met(
    trigger: &Trigger,
    clump: &Clump,
    squeeze: Option<&Squeeze>,
    state: &State,
) -> Option<&'static str> {
    let enters = trigger
        .enters
        .map(|region| state.model.rules.regions[region].contains(clump.place_m));
    let force = trigger
        .force_n
        .map(|limit| Vector3::from(clump.force_n).norm() > limit);
    let energy = trigger
        .impact_energy_j
        .map(|limit| clump.impact_energy_j > limit);
    let contact_force = trigger
        .contact_force_n
        .map(|limit| squeeze.is_some_and(|squeeze| squeeze.largest_n > limit));
    let principal_stress = trigger.principal_stress.map(|stress| {
        let volume_m3 = stress.volume_m3_kg * state.clumps.template(clump).mass_kg;
        squeeze.is_some_and(|squeeze| squeeze.principal_stress_pa(volume_m3) > stress.limit_pa)
    });
    // A trigger time has passed for good: a restored clump needs another condition.
    let is_again = state
        .population
        .base_of_cluster
        .contains_key(&clump.cluster);
    let time = trigger.time_s.filter(|_| !is_again);
    let time = time.map(|from| state.time_s >= from);
    let all = [enters, force, contact_force, principal_stress, energy, time];
    let mut asked = CAUSES
        .into_iter()
        .zip(all)
        .filter_map(|(name, met)| met.map(|met| (name, met)));
    if trigger.needs_all {
        let first = asked.clone().next()?.0;
        asked.all(|(_, met)| met).then_some(first)
    } else {
        asked.find(|(_, met)| *met).map(|(name, _)| name)
    }
}

/// Turns clumps into clusters; records mass, momentum and energy before and after.
fn swap(state: &mut State, to_clusters: Vec<usize>, causes: &[&'static str]) {
    // A body that an inlet feeds as bonded starts this way.
    let fired = causes.iter().filter(|cause| **cause != STARTS_BONDED);
    state.population.replaced += fired.count() as u32;
    let changes = TopologyChange {
        to_clusters,
        ..TopologyChange::default()
    };
    let renumbered = apply_topology_change(state, changes);
    for (created, cause) in renumbered.created.iter().zip(causes) {
        let (clump, template) = (&created.clump, &created.template);
        if template.bonds.is_empty() && *cause == STARTS_BONDED {
            // A single sphere: nothing restores it.
            continue;
        }
        let of_scene = (state.base_of(clump.template), clump.instance);
        (state.population.base_of_cluster).insert(clump.cluster, of_scene);
        let p = &state.particles;
        let (mut mass, mut momentum, mut kinetic) = (0.0, Vector3::zeros(), 0.0);
        for i in created.first_particle..created.first_particle + template.spheres.len() {
            let motion = &p.motions[i];
            mass += 1.0 / motion.inverse_mass;
            momentum += Vector3::from(motion.velocity_m_s) / motion.inverse_mass;
            kinetic += p.kinetic_j(i, motion);
        }
        state
            .scratch
            .events
            .population
            .push(PopulationEvent::Replaced {
                cluster: clump.cluster,
                body: template.body.clone(),
                cause,
                mass_kg: [template.mass_kg, mass],
                momentum_n_s: [
                    template.mass_kg * Vector3::from(clump.velocity_m_s).norm(),
                    momentum.norm(),
                ],
                kinetic_j: [clump.kinetic_j(template), kinetic],
                place_m: clump.place_m,
            });
    }
    state.scratch.events.renumberings.push(renumbered);
}
