//! Clusters that become rigid clumps again: complete bodies and fragments that have left a region
//! or whose bonds hold for some time, and that have come to rest internally. Not in Platzer 2022.
//!
//! Relative motion of the particles is lost. The strain of a fragment, and of a complete body that
//! touches something, is kept in its template and returns if it becomes a cluster again. The strain
//! of a complete body that touches nothing is lost, as the body takes the shape of its file: with
//! contacts that would change their overlaps, and so their energy. All of it is recorded.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::stages::contacts::touching::touching;
use crate::stages::ledger::totals::synchronous_motions;
use crate::stages::population::change::apply_topology_change;
use crate::state::State;
use crate::state::bonds::Bonds;
use crate::state::clumps::{Clump, Template, breaks_from_n_m, reach_m, slender_body, sub_spheres};
use crate::state::clusters::fragments::{Fragment, fragment, mass_and_centre};
use crate::state::events::PopulationEvent;
use crate::state::events::Renumbering;
use crate::state::events::TopologyChange;
use crate::state::particles::Motion;
use crate::state::population::FragmentTemplate;
use crate::state::rigid_parts::as_rigid;
use dem_physics::rotation::rotation;
use dem_physics::shape::fit::best_rotation;
use dem_physics::shape::inertia::MassProperties;
use dem_physics::shape::outer_layer::{HIDDEN, outer_layer};

/// Interval between checks of the clusters, in steps.
const EVERY: u64 = 200;

/// Turns clusters that meet the conditions back into clumps, between a kick and the drift after it.
/// Returns 1 if it has checked for them.
pub fn restore_clumps(state: &mut State) -> usize {
    let rules = &state.model.rules;
    if rules.are_none()
        || rules.restores.iter().all(Option::is_none)
        || !state.steps.is_multiple_of(EVERY)
    {
        return 0;
    }
    if let Some((renumbering, restored)) = restore(state) {
        state.population.restored += restored.len() as u32;
        state.scratch.events.renumberings.push(renumbering);
        state.scratch.events.population.extend(restored);
    }
    1
}

/// The clusters that have become clumps again. None: there are none.
fn restore(state: &mut State) -> Option<(Renumbering, Vec<PopulationEvent>)> {
    let clusters = state.clusters.as_ref()?;
    let due: Vec<(u32, usize, u32)> = (clusters.living())
        .filter_map(|id| is_due(id, state).map(|(base, instance)| (id, base, instance)))
        .collect();
    if due.is_empty() {
        return None;
    }
    // Energies are those at the time of the positions: between particles they change within a step.
    let motions = synchronous_motions(state);
    let clusters = state.clusters.as_ref()?;
    let mut to_clumps = Vec::new();
    let mut happened = Vec::new();
    let mut gained_j = 0.0;
    for (id, base, instance) in due {
        let Some(rule) = &state.model.rules.restores[base] else {
            continue;
        };
        let fragment = fragment(id, clusters, &state.particles, &motions);
        let members = clusters.members(id);
        let inner_j = inner_kinetic_j(&fragment, members, &motions, state);
        if 2.0 * inner_j >= rule.inner_speed_m_s.powi(2) * fragment.mass_kg {
            continue;
        }
        let poses = &state.particles.poses;
        let strain_j: f64 = (own_bonds(members, state).into_iter())
            .map(|at| state.bonds.forces(at, poses).energy.total())
            .sum();
        if strain_j >= rule.strain_energy_j_kg * fragment.mass_kg {
            continue;
        }
        gained_j -= inner_j.max(0.0) + strain_j;
        happened.push(PopulationEvent::Restored {
            cluster: id,
            body: state.clumps.templates[base].body.clone(),
            particles: fragment.particles,
            lost_j: inner_j.max(0.0) + strain_j,
            place_m: fragment.centre_m,
        });
        to_clumps.push((id, base, instance));
    }
    if to_clumps.is_empty() {
        return None;
    }
    let touched = touching(state);
    let to_clumps = to_clumps
        .into_iter()
        .map(|(id, base, instance)| {
            let members = state
                .clusters
                .as_ref()
                .map_or(Vec::new(), |c| c.members(id).to_vec());
            let is_free = !members.iter().any(|i| touched.contains(i));
            let clump = as_clump(id, base, (&members, is_free), state);
            (id, Clump { instance, ..clump })
        })
        .collect();
    state.ledger.gain(gained_j);
    let changes = TopologyChange {
        to_clumps,
        ..TopologyChange::default()
    };
    Some((apply_topology_change(state, changes), happened))
}

/// The template of the body that a cluster comes from, and its instance. None: it never was a
/// clump.
fn base_of(id: u32, state: &State) -> Option<(usize, u32)> {
    let history = &state.clusters.as_ref()?.history;
    let mut id = id;
    loop {
        if let Some(&(base, instance)) = state.population.base_of_cluster.get(&id) {
            return Some((base as usize, instance));
        }
        id = history[id as usize].parent?;
    }
}

/// The template and the instance of the body that a cluster comes from, if the cluster is large
/// enough to be a clump again, has been without a break for long enough and has left the region.
fn is_due(id: u32, state: &State) -> Option<(usize, u32)> {
    let members = state.clusters.as_ref()?.members(id);
    let p = &state.particles;
    if *members.first()? as usize >= p.free {
        return None;
    }
    let (base, instance) = base_of(id, state)?;
    let rule = state.model.rules.restores[base].as_ref()?;
    if members.len() < rule.min_particles as usize {
        return None;
    }
    if state.time_s - state.clusters.as_ref()?.history[id as usize].unbroken_since_s
        < rule.unbroken_for_s
    {
        return None;
    }
    let is_in = |region: usize| {
        let (_, centre) = mass_and_centre(members, p);
        state.model.rules.regions[region].contains(centre.into())
    };
    (!rule.leaves.is_some_and(is_in)).then_some((base, instance))
}

/// Kinetic energy of a cluster in excess of that of a rigid body with the same momenta, J.
fn inner_kinetic_j(fragment: &Fragment, members: &[u32], motions: &[Motion], state: &State) -> f64 {
    let p = &state.particles;
    let all: f64 = (members.iter())
        .map(|&i| p.kinetic_j(i as usize, &motions[i as usize]))
        .sum();
    let velocity = Vector3::from(fragment.velocity_m_s);
    let spin = Vector3::from(fragment.angular_velocity_rad_s);
    let turning = spin.dot(&Vector3::from(fragment.angular_momentum_kg_m2_s));
    all - 0.5 * (fragment.mass_kg * velocity.norm_squared() + turning)
}

/// The clump that replaces a cluster with these members, which are free if they touch nothing; adds
/// its template unless it is that of the complete body.
fn as_clump(id: u32, base: usize, (members, is_free): (&[u32], bool), state: &mut State) -> Clump {
    let p = &state.particles;
    let (properties, [velocity, angular]) = as_rigid(members, &p.poses, &p.motions);
    let whole = Arc::clone(&state.clumps.templates[base]);
    let bonds: Vec<usize> = own_bonds(members, state);
    let known = &state.bonds;
    let is_deformed = |&at: &usize| known.was_damaged(at) || known.has_yielded(at);
    let is_whole = is_free
        && members.len() == whole.spheres.len()
        && bonds.len() == whole.bonds.len()
        && !bonds.iter().any(is_deformed);
    let first_id = match members.first() {
        Some(&first) if is_whole => p.id(first as usize) - whole.file_number[0],
        _ => 0,
    };
    let (template, turned) = if is_whole {
        let centre = Vector3::from(properties.centre_m);
        let places = members.iter().map(|&i| p.poses[i as usize].place());
        let arms: Vec<[f64; 3]> = places.map(|place| (place - centre).into()).collect();
        let inverse = members.iter().map(|&i| p.motions[i as usize].inverse_mass);
        let masses: Vec<f64> = inverse.map(|inverse| 1.0 / inverse).collect();
        let from: Vec<[f64; 3]> = whole.spheres.iter().map(|s| s.place_m).collect();
        (base as u32, best_rotation(&from, &arms, &masses))
    } else {
        let template = fragment_template(&whole, members, &bonds, &properties, state);
        let template = Arc::new(template);
        state.clumps.templates.push(Arc::clone(&template));
        let base = base as u32;
        state
            .population
            .fragments
            .push(FragmentTemplate { base, template });
        (state.clumps.templates.len() as u32 - 1, properties.axes)
    };
    Clump {
        template,
        cluster: id,
        first_id,
        place_m: properties.centre_m,
        turned,
        velocity_m_s: velocity.into(),
        angular_momentum: angular.into(),
        rigid_while_touching: true,
        ..Clump::default()
    }
}

/// Unbroken bonds between members of a cluster (ascending), in order.
fn own_bonds(members: &[u32], state: &State) -> Vec<usize> {
    let ends = &state.bonds.ends;
    let mut found = Vec::new();
    for &i in members {
        let from = ends.partition_point(|[a, _]| *a < i);
        let own = ends[from..].iter().take_while(|[a, _]| *a == i).count();
        found.extend((from..from + own).filter(|&at| {
            !state.bonds.is_broken(at) && members.binary_search(&ends[at][1]).is_ok()
        }));
    }
    found
}

fn fragment_template(
    whole: &Template,
    members: &[u32],
    bonds: &[usize],
    properties: &MassProperties,
    state: &State,
) -> Template {
    let p = &state.particles;
    let particles = members
        .iter()
        .map(|&i| (&p.poses[i as usize], &p.motions[i as usize]));
    let spheres = sub_spheres(particles, properties);
    let mut own = Bonds {
        rules: state.bonds.rules.clone(),
        ..Bonds::default()
    };
    for &at in bonds {
        let ends = state.bonds.ends[at].map(|end| members.partition_point(|&m| m < end) as u32);
        own.push_copy(&state.bonds, at, ends, 1.0);
    }
    // Summed loads, which are in the axes of space, turn with the clump from now on.
    own.turn_histories(0, &rotation(properties.axes).inverse());
    let centres: Vec<[f64; 3]> = spheres.iter().map(|s| s.place_m).collect();
    let radii: Vec<f64> = spheres.iter().map(|s| s.radius_m).collect();
    Template {
        body: whole.body.clone(),
        mass_kg: properties.mass_kg,
        moments_kg_m2: properties.moments_kg_m2,
        axes: [0.0, 0.0, 0.0, 1.0],
        centre_m: [0.0; 3],
        reach_m: reach_m(&spheres),
        outer: Arc::new(outer_layer(&centres, &radii, HIDDEN, state.model.ball_m)),
        scale: 1.0,
        material: whole.material,
        file_number: Arc::new((0..spheres.len() as u32).collect()),
        ids: members.iter().map(|&i| p.id(i as usize)).collect(),
        scatter: None,
        bonds_of_file: Arc::new((0..own.len() as u32).collect()),
        breaks_from_n_m: breaks_from_n_m(&own, &spheres),
        slender: slender_body(
            &own,
            &spheres,
            (properties.mass_kg, properties.moments_kg_m2),
        ),
        bonds: Arc::new(own),
        spheres: Arc::new(spheres),
        landing: Default::default(),
    }
}
