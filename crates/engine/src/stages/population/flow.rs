//! Bodies enter through inlets and leave through outlets.

use super::append::add_clumps;
use super::change::apply_topology_change;
use super::inlets::coming;
use super::outlets::leaving;
use crate::stages::stage::{Need, Stage};
use crate::state::State;
use crate::state::events::TopologyChange;

/// Inlets and outlets.
pub(crate) const FLOW: Stage = Stage::new("inlets and outlets", |state, _| {
    let (inlets, outlets) = (
        state.model.rules.inlets.len(),
        state.model.rules.outlets.len(),
    );
    Need::of(
        inlets + outlets > 0,
        || format!("{inlets} and {outlets}"),
        "no body comes or goes",
    )
});

/// Adds and removes bodies, between a kick and the drift after it. Returns the number of inlets and
/// outlets checked.
pub(crate) fn apply_inlets_and_outlets(state: &mut State) -> usize {
    let leaving = leaving(state);
    let coming = coming(state);
    if !(leaving.is_empty() && coming.is_empty()) {
        let renumbering = if leaving.is_empty() && state.sleep.is_none() {
            add_clumps(state, coming)
        } else {
            let changes = TopologyChange {
                coming,
                leaving,
                ..TopologyChange::default()
            };
            apply_topology_change(state, changes)
        };
        state.scratch.events.renumberings.push(renumbering);
    }
    state.model.rules.inlets.len() + state.model.rules.outlets.len()
}

/// Counts the existing bonds, and those skipped because their bodies are clumps or they are within
/// rigid parts.
pub(crate) fn count_bond_steps(state: &mut State) -> usize {
    let rules = &state.model.rules;
    if !(rules.are_none() && rules.zones.is_empty()) {
        let clumps = state.clumps.all.iter();
        let left_out = clumps.map(|clump| state.clumps.template(clump).bonds.len() as u64);
        let rigid = state.rigid_parts.bonds;
        state.population.bond_steps[1] += left_out.sum::<u64>() + rigid;
        state.population.bond_steps[0] += state.bonds.len() as u64 - rigid;
    }
    0
}
