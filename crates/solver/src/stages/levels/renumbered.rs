//! Steps by body: the particles and what they can become, when bodies are added, removed or
//! replaced.

use crate::state::State;
use crate::state::events::NewCluster;

/// For each template, those of fragments included, the number of its cluster in the rule.
fn wholes(state: &State) -> Vec<u32> {
    let Some(rule) = &state.model.levels else {
        return Vec::new();
    };
    let templates = 0..state.clumps.templates.len() as u32;
    let whole = |template: u32| rule.own_of_template[state.base_of(template) as usize];
    templates.map(whole).collect()
}

/// Sets for each sphere of a clump what the clump can become.
pub(crate) fn note_wholes_of_clumps(state: &mut State) {
    let wholes = wholes(state);
    note_wholes(state, &wholes);
}

fn note_wholes(state: &mut State, wholes: &[u32]) {
    let Some(levels) = &mut state.levels else {
        return;
    };
    levels.whole_of.resize(state.particles.len(), 0);
    for clump in &state.clumps.all {
        let spheres = state.clumps.spheres_of(clump);
        levels.whole_of[spheres].fill(wholes[clump.template as usize]);
    }
}

/// Renumbers the particles after some were added, removed or replaced. New ones take single time
/// steps until the levels are set again.
pub(crate) fn renumber_levels(state: &mut State, particles: &[u32], created: &[NewCluster]) {
    let count = state.particles.len();
    let wholes = wholes(state);
    let Some(levels) = &mut state.levels else {
        return;
    };
    levels.of_particle = renumbered(&levels.of_particle, particles, count);
    if !levels.scratch.before.is_empty() {
        levels.scratch.before = renumbered(&levels.scratch.before, particles, count);
    }
    levels.whole_of = renumbered(&levels.whole_of, particles, count);
    for created in created {
        let spheres = created.template.spheres.len();
        let own = created.first_particle..created.first_particle + spheres;
        levels.whole_of[own].fill(wholes[created.clump.template as usize]);
    }
    levels.scratch.groups.clear();
    levels.scratch.is_renumbered = true;
    note_wholes(state, &wholes);
}

fn renumbered<T: Copy + Default>(of_old: &[T], particles: &[u32], count: usize) -> Vec<T> {
    let mut of_new = vec![T::default(); count];
    for (one, &now) in of_old.iter().zip(particles) {
        if let Some(place) = of_new.get_mut(now as usize) {
            *place = *one;
        }
    }
    of_new
}
