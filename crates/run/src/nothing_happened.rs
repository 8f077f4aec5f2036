//! Measures of something that never happened: a force of nothing, the density of an empty region.

use dem_scene::Scene;

use super::monitors::Monitors;
use dem_engine::state::State;
use dem_engine::state::watches::{MAGNITUDE, Recorded};
use dem_plan::measure::{IfZero, Probe};

/// Measures that are 0 throughout because nothing touched what they measure, or nothing came to
/// their region, a sentence each.
pub(super) fn empty_measures(
    state: &State,
    scene: &Scene,
    probes: &[Probe],
    monitors: &Monitors,
) -> Vec<String> {
    let said = zero(probes).filter_map(|probe| {
        let why = match probe.measurement().if_zero {
            IfZero::Untouched => untouched(state, scene, probe, monitors),
            IfZero::Doubt(why) => why(&probe.measure),
            IfZero::Fine | IfZero::Note(_) => None,
        }?;
        Some(format!("measures.{} is 0 throughout: {why}", probe.name))
    });
    said.collect()
}

/// The measures that are 0 throughout.
fn zero(probes: &[Probe]) -> impl Iterator<Item = &Probe> {
    probes.iter().filter(|probe| {
        let history = &probe.history;
        history.largest == Some(0.0) && history.smallest == Some(0.0)
    })
}

/// What nothing touched, and the remedy.
fn untouched(state: &State, scene: &Scene, probe: &Probe, monitors: &Monitors) -> Option<String> {
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
    let is_never = match probe.measurement().recorded {
        Some(Recorded::Force) => probe.measure.part == MAGNITUDE,
        recorded => recorded == Some(Recorded::Duration),
    };
    let with = probe.measure.with.as_ref().filter(|_| is_never)?;
    Some(format!(
        "'{of}' and '{with}' did not touch each other; {remedy}"
    ))
}

/// Notes on measures that are 0 throughout, a sentence each: this may be what was asked for.
pub(super) fn zero_measures(probes: &[Probe]) -> Vec<String> {
    let said = zero(probes).filter_map(|probe| {
        let IfZero::Note(what) = probe.measurement().if_zero else {
            return None;
        };
        let what = what(&probe.measure)?;
        Some(format!("measures.{} is 0 throughout: {what}", probe.name))
    });
    said.collect()
}

/// A note on bodies that broke although their pieces cannot touch each other.
pub(super) fn parted_without_contacts(state: &State) -> Option<String> {
    (state.broken_count > 0 && state.contacts.is_none()).then(|| {
        "bonds broke, and [contacts] is empty: the pieces pass through each other".to_owned()
    })
}
