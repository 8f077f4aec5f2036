//! Clumps that are added, where nothing else changes. No particle gets another number: lists grow
//! at their ends, and nothing is copied or placed anew.

use std::sync::Arc;

use crate::stages::search::lists::lengthen_lists;
use crate::state::State;
use crate::state::clumps::{Clump, Clumps};
use crate::state::clusters::Cluster;
use crate::state::events::Renumbering;
use crate::state::particles::Wrench;

/// Adds clumps, each with a number of its own among the clusters, to a scene without sleep.
pub(super) fn add_clumps(state: &mut State, coming: Vec<Clump>) -> Renumbering {
    state.scratch.surroundings.clear();
    let before = [state.particles.len(), state.clumps.all.len()];
    for clump in coming {
        let number = state
            .clusters
            .as_ref()
            .map_or(0, |c| c.history.len() as u32);
        let (mut clump, cluster) = arrived(state, clump, number);
        let template = Arc::clone(state.clumps.template(&clump));
        Clumps::push_spheres(&template, &mut clump, &mut state.particles);
        // Nothing is known to be near it before the next search.
        clump.near = [state.clumps.near.len() as u32; 2];
        state.clumps.all.push(clump);
        if let Some(clusters) = &mut state.clusters {
            clusters.append(cluster);
        }
        if let Some(contacts) = &mut state.contacts {
            contacts
                .materials
                .resize(state.particles.len(), template.material);
        }
    }
    let count = state.particles.len();
    if !state.scratch.particle_resistance.is_empty() {
        state
            .scratch
            .particle_resistance
            .resize(count, Wrench::default());
    }
    let partitions = state.wanted_partitions();
    if let Some(contacts) = &mut state.contacts {
        contacts.lost_j.resize(count, [0.0; 2]);
        contacts.divide(count, partitions);
        lengthen_lists(contacts, &state.particles, &state.clumps, before);
    }
    Renumbering {
        particles: (0..before[0] as u32).collect(),
        bonds: (0..state.bonds.len() as u32).collect(),
        free: state.particles.free as u32,
        created: Vec::new(),
    }
}

/// A clump that is added at this time, and its cluster, which has this number.
pub(super) fn arrived(state: &mut State, mut clump: Clump, number: u32) -> (Clump, Cluster) {
    let template = state.clumps.template(&clump);
    clump.cluster = number;
    clump.first_id = state.population.next_particle_id;
    state.population.next_particle_id += template.spheres.len() as u32;
    let cluster = Cluster {
        parent: None,
        body: state.model.body_number(&template.body),
        created_s: state.time_s,
        unbroken_since_s: state.time_s,
        ended_s: None,
        particles: template.outer.len() as u32,
    };
    (clump, cluster)
}
