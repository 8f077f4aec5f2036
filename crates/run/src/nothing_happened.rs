//! Measures of something that never happened: a force of nothing, the density of an empty region.

use dem_scene::{Quantity, Scene};

use super::monitors::Monitors;
use dem_engine::state::State;
use dem_plan::measure::Probe;

/// Measures that are 0 throughout because nothing touched what they measure, or nothing came to
/// their region, a sentence each.
pub(super) fn empty_measures(
    state: &State,
    scene: &Scene,
    probes: &[Probe],
    monitors: &Monitors,
) -> Vec<String> {
    let is_zero = |probe: &&Probe| {
        let history = &probe.history;
        history.largest == Some(0.0) && history.smallest == Some(0.0)
    };
    let zero = probes.iter().filter(is_zero);
    let said = zero.filter_map(|probe| {
        let why = untouched(state, scene, probe, monitors).or_else(|| empty_region(probe))?;
        Some(format!("measures.{} is 0 throughout: {why}", probe.name))
    });
    said.collect()
}

/// What nothing touched, if a measure is of forces or contacts, and the remedy.
fn untouched(state: &State, scene: &Scene, probe: &Probe, monitors: &Monitors) -> Option<String> {
    let quantity = probe.measure.quantity;
    let is_force = matches!(
        quantity,
        Quantity::Force(_) | Quantity::ForceMagnitude | Quantity::Torque(_)
    );
    if !(is_force || quantity.is_of_contact()) {
        return None;
    }
    let remedy = "check places and motions, or set run.end_time later";
    let wall_name = |wall: usize| state.walls.get(wall).map(|wall| wall.model.name.clone());
    let walls = probe.walls().into_iter().flatten();
    let untouched_wall = walls
        .into_iter()
        .find(|wall| !monitors.has_touched_wall(*wall));
    if let Some(name) = untouched_wall.and_then(wall_name) {
        return Some(format!("nothing touched the wall '{name}'; {remedy}"));
    }
    let of = &probe.measure.of;
    if probe.walls()[0].is_none() && monitors.is_untouched(scene, of) {
        return Some(format!("nothing touched '{of}'; {remedy}"));
    }
    // A component may be 0 by symmetry, these are not.
    let is_never = matches!(
        quantity,
        Quantity::ContactForceMagnitude | Quantity::ContactDuration
    );
    let with = probe.measure.with.as_ref().filter(|_| is_never)?;
    Some(format!(
        "'{of}' and '{with}' did not touch each other; {remedy}"
    ))
}

/// Notes on measures that are 0 throughout, a sentence each: this may be what was asked for.
pub(super) fn zero_measures(probes: &[Probe]) -> Vec<String> {
    let is_zero = |probe: &&Probe| {
        let history = &probe.history;
        history.largest == Some(0.0) && history.smallest == Some(0.0)
    };
    let said = probes.iter().filter(is_zero).filter_map(|probe| {
        let of = &probe.measure.of;
        let what = match (probe.measure.quantity, &probe.measure.within) {
            (Quantity::Displacement(_) | Quantity::DisplacementMagnitude, _) => {
                format!("'{of}' did not move that way")
            }
            (Quantity::Reaction(_) | Quantity::ReactionTorque(_), _) => {
                format!("the supports of '{of}' carry nothing that way")
            }
            (Quantity::Mass, Some(within)) => {
                format!("nothing of '{of}' ever was in the region '{within}'")
            }
            _ => return None,
        };
        Some(format!("measures.{} is 0 throughout: {what}", probe.name))
    });
    said.collect()
}

fn empty_region(probe: &Probe) -> Option<String> {
    let within = probe.measure.within.as_ref()?;
    (probe.measure.quantity == Quantity::BulkDensity).then(|| {
        format!(
            "nothing of '{}' ever was in the region '{within}'; check its place and size",
            probe.measure.of
        )
    })
}

/// A note on bodies that broke although their pieces cannot touch each other.
pub(super) fn parted_without_contacts(state: &State) -> Option<String> {
    (state.broken_count > 0 && state.contacts.is_none()).then(|| {
        "bonds broke, and [contacts] is empty: the pieces pass through each other".to_owned()
    })
}
