//! Steps by body: the particles and what they can become, when bodies are added, removed or
//! replaced.

use crate::state::State;
use crate::state::events::NewCluster;

/// Number, in the rule, of the cluster that a clump of a template can become.
fn whole(state: &State, template: u32) -> u32 {
    let rule = state.model.levels.as_ref();
    rule.map_or(0, |rule| {
        rule.own_of_template[state.base_of(template) as usize]
    })
}

/// Sets for each sphere of a clump what the clump can become.
pub(crate) fn note_wholes_of_clumps(state: &mut State) {
    let Some(mut levels) = state.levels.take() else {
        return;
    };
    levels.whole_of.resize(state.particles.len(), 0);
    for clump in &state.clumps.all {
        levels.whole_of[state.clumps.spheres_of(clump)].fill(whole(state, clump.template));
    }
    state.levels = Some(levels);
}

/// Renumbers the particles after some were added, removed or replaced. New ones take single time
/// steps until the levels are set again.
pub(crate) fn renumber_levels(state: &mut State, particles: &[u32], created: &[NewCluster]) {
    let count = state.particles.len();
    let Some(mut levels) = state.levels.take() else {
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
        levels.whole_of[own].fill(whole(state, created.clump.template));
    }
    levels.scratch.groups.clear();
    levels.scratch.is_renumbered = true;
    state.levels = Some(levels);
    note_wholes_of_clumps(state);
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
