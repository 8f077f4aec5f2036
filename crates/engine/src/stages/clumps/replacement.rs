//! Clumps that become bonded clusters (BPRM: Platzer 2022, section 4.5.4).

use nalgebra::Vector3;

use super::contact_stress::find_squeezes;
use super::touched::find_touched;
use crate::stages::population::change::apply_topology_change;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::clumps::Clump;
use crate::state::events::TopologyChange;
use crate::state::events::{PopulationEvent, STARTS_BONDED};
use crate::state::rules::Trigger;
use dem_physics::clump_stress::Squeeze;

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

/// Contacts that triggers by touch, single forces or stress read.
pub(crate) const SQUEEZE: Stage = Stage {
    within: Some(REPLACEMENT.name),
    ..Stage::new("squeeze of clumps", |state, _| {
        let mut triggers = state.model.rules.triggers.iter().flatten();
        Need::of(
            state.contacts.is_some()
                && triggers.any(|trigger| trigger.touches.is_some() || trigger.needs_squeeze()),
            || "a trigger reads single contacts".to_owned(),
            "no trigger reads single contacts",
        )
    })
};

/// The conditions of a trigger, in the order in which they are asked.
const CAUSES: [&str; 7] = [
    "enters",
    "touches",
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
    let mut touched = std::mem::take(&mut state.scratch.touched);
    state.scratch.squeezing += find_squeezes(state, &mut squeezes);
    state.scratch.squeezing += find_touched(state, &mut touched);
    // The contacts of those that sleep are kept elsewhere, and stay.
    let awake = (state.clumps.all.iter_mut().zip(&touched)).filter(|(clump, _)| !clump.asleep);
    awake.for_each(|(clump, &touched)| clump.rigid_while_touching &= touched);
    let found = triggered(state, &squeezes, &touched).collect();
    state.scratch.squeezes = squeezes;
    state.scratch.touched = touched;
    found
}

/// Clumps that become clusters: their numbers and the causes.
fn triggered(
    state: &State,
    squeezes: &[Squeeze],
    touched: &[bool],
) -> impl Iterator<Item = (usize, &'static str)> {
    let rules = &state.model.rules;
    (state.clumps.all.iter().enumerate()).filter_map(move |(n, clump)| {
        let template = clump.template as usize;
        let start = rules.starts.get(template);
        if start.is_some_and(|start| start.bonded || start.sphere) {
            return Some((n, STARTS_BONDED));
        }
        let base = state.base_of(clump.template) as usize;
        let trigger = rules.triggers.get(base)?.as_ref()?;
        let touches = touched.get(n) == Some(&true) && !clump.rigid_while_touching;
        Some((n, met(trigger, clump, (touches, squeezes.get(n)), state)?))
    })
}

/// The condition of a trigger that a clump meets, or the first one if it needs all and meets all.
/// `touched`: by what the trigger names; `squeeze`: None if no trigger needs it, or nothing can
/// touch.
fn met(
    trigger: &Trigger,
    clump: &Clump,
    (touched, squeeze): (bool, Option<&Squeeze>),
    state: &State,
) -> Option<&'static str> {
    let enters = trigger
        .enters
        .map(|region| state.model.rules.regions[region].contains(clump.place_m));
    let touches = trigger.touches.as_ref().map(|_| touched);
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
        let mean_pa = squeeze.map_or(0.0, |squeeze| squeeze.principal_stress_pa(volume_m3));
        mean_pa.max(clump.hits.bending_pa) > stress.limit_pa
    });
    // A trigger time has passed for good: a restored clump needs another condition.
    let is_again = || {
        let is_fragment = clump.template as usize >= state.model.rules.triggers.len();
        let known = &state.population.base_of_cluster;
        is_fragment || known.contains_key(&clump.cluster)
    };
    let time = trigger.time_s.filter(|_| !is_again());
    let time = time.map(|from| state.time_s >= from);
    let all = [
        enters,
        touches,
        force,
        contact_force,
        principal_stress,
        energy,
        time,
    ];
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
