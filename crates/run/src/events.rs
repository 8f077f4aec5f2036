//! Entries of the table of events.

use dem_io::Result;
use dem_io::text::exact;
use dem_results::{DischargeRow, Event};

use super::files::Files;
use crate::output::fragments::split_text;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_engine::state::bodies::bond_of_file;
use dem_engine::state::clusters::sizes::Discharged;
use dem_engine::state::events::PopulationEvent;
use dem_engine::state::events::STARTS_BONDED;
use dem_plan::time_step::StepChoice;

/// The bonds that broke in this step, by the numbers of the body's file.
pub(super) fn write_breaks(
    state: &State,
    bodies: &[PlacedBody],
    files: &mut Files<'_>,
) -> Result<()> {
    for broken in &state.scratch.events.broken {
        let ends = state.bonds.ends[broken.bond as usize];
        let found = bond_of_file(bodies, broken.bond as usize);
        let mut ends = ends.map(|end| {
            found
                .and_then(|(body, _)| body.number_of(end))
                .map(u64::from)
        });
        ends.sort_unstable();
        let event = Event {
            step: state.steps,
            time_s: state.time_s,
            kind: "bond_broken",
            bond: found.map(|(_, number)| u64::from(number)),
            particle_a: ends[0],
            particle_b: ends[1],
            position_m: Some(broken.place_m),
            cause: broken.cause.name(),
            energy_j: Some(broken.released_j),
            detail: found.map_or("", |(body, _)| &body.name),
        };
        files.events.append(&[event])?;
    }
    Ok(())
}

/// The clusters that were found in pieces in this step.
pub(super) fn write_splits(state: &State, files: &mut Files<'_>) -> Result<()> {
    let Some(clusters) = &state.clusters else {
        return Ok(());
    };
    let details: Vec<String> = state
        .scratch
        .events
        .splits
        .iter()
        .map(|split| split_text(split, &clusters.history))
        .collect();
    let events: Vec<Event<'_>> = details
        .iter()
        .map(|detail| of_all(state, "split", "", detail))
        .collect();
    files.events.append(&events)
}

/// Mass, kg, momentum, N s, and kinetic energy, J, before and after an event.
fn kept(mass_kg: &[f64; 2], momentum_n_s: &[f64; 2], kinetic_j: &[f64; 2]) -> String {
    let both = |[before, after]: &[f64; 2]| format!("{} -> {}", exact(*before), exact(*after));
    format!(
        "mass {} kg; momentum {} N s; kinetic energy {} J",
        both(mass_kg),
        both(momentum_n_s),
        both(kinetic_j)
    )
}

/// Events of bodies in this step.
pub(super) fn write_population(state: &State, files: &mut Files<'_>) -> Result<()> {
    let (step, time_s) = (state.scratch.events.step, state.scratch.events.time_s);
    for one in &state.scratch.events.population {
        let (kind, cause, place_m, energy_j, detail) = match one {
            PopulationEvent::Replaced {
                cluster,
                body,
                cause,
                mass_kg,
                momentum_n_s,
                kinetic_j,
                place_m,
            } => (
                if *cause == STARTS_BONDED {
                    "bonded"
                } else {
                    "replaced"
                },
                *cause,
                place_m,
                Some(kinetic_j[1] - kinetic_j[0]),
                format!(
                    "fragment {cluster} ({body}): {}",
                    kept(mass_kg, momentum_n_s, kinetic_j)
                ),
            ),
            PopulationEvent::Broken {
                cluster,
                body,
                class,
                daughters: (class_body, count),
                specific_j_kg,
                mass_kg,
                momentum_n_s,
                kinetic_j,
                place_m,
            } => (
                "replaced",
                "specific_energy",
                place_m,
                Some(kinetic_j[1] - kinetic_j[0]),
                format!(
                    "fragment {cluster} ({body}): {} J/kg; class {} ({class_body}); {count} daughters; {}",
                    exact(*specific_j_kg),
                    class + 1,
                    kept(mass_kg, momentum_n_s, kinetic_j)
                ),
            ),
            PopulationEvent::Restored {
                cluster,
                body,
                particles,
                lost_j,
                place_m,
            } => (
                "restored",
                "quiet",
                place_m,
                Some(*lost_j),
                format!("fragment {cluster} ({body}): {particles} particles"),
            ),
            PopulationEvent::Came {
                cluster,
                body,
                inlet,
                place_m,
            } => (
                "fed",
                inlet.as_str(),
                place_m,
                None,
                format!("fragment {cluster} ({body})"),
            ),
            PopulationEvent::Left {
                cluster,
                body,
                outlet,
                mass_kg,
                place_m,
            } => (
                "discharged",
                outlet.as_str(),
                place_m,
                None,
                format!("fragment {cluster} ({body}): {mass_kg:e} kg"),
            ),
        };
        files.events.append(&[Event {
            step,
            time_s,
            position_m: Some(*place_m),
            energy_j,
            ..of_all(state, kind, cause, &detail)
        }])?;
    }
    Ok(())
}

/// What has left through outlets since the last call.
pub(super) fn write_discharge(state: &State, files: &mut Files<'_>) -> Result<()> {
    let Some((file, written)) = &mut files.discharge else {
        return Ok(());
    };
    let all = &state.population.discharged;
    let (model, outlets) = (&state.model, &state.model.rules.outlets);
    let row = |one: &Discharged| DischargeRow {
        time_s: one.time_s,
        fragment_id: one.fragment_id,
        body: model.body_name(one.size.body),
        material: model.material_name(one.size.body),
        outlet: &outlets[one.outlet as usize].name,
        mass_kg: one.size.mass_kg,
        equivalent_diameter_m: one.size.equivalent_diameter_m,
        box_lengths_m: one.size.box_lengths_m,
        sieve_m: one.size.sieve_m,
    };
    file.append(all[*written..].iter().map(row))?;
    *written = all.len();
    Ok(())
}

/// The spheres of bodies bonded in part that were released or joined a rigid part in this step.
pub(super) fn write_zones(state: &State, files: &mut Files<'_>) -> Result<()> {
    for news in &state.scratch.events.zones {
        let plural = if news.particles == 1 { "" } else { "s" };
        files.events.append(&[Event {
            step: news.step,
            time_s: news.time_s,
            energy_j: Some(news.lost_j),
            ..of_all(
                state,
                news.kind,
                "region",
                &format!("{}: {} particle{plural}", news.body, news.particles),
            )
        }])?;
    }
    Ok(())
}

/// The bodies that fell asleep or woke in this step.
pub(super) fn write_sleep(state: &State, files: &mut Files<'_>) -> Result<()> {
    for news in &state.scratch.events.sleep {
        let plural = if news.bodies == 1 { "body" } else { "bodies" };
        files.events.append(&[Event {
            step: news.step,
            time_s: news.time_s,
            ..of_all(
                state,
                news.kind,
                news.cause,
                &format!("{} {plural}", news.bodies),
            )
        }])?;
    }
    Ok(())
}

/// Takes the time step of the scene in a resumed run: a given step, or one smaller than before; an
/// adaptive step stays as it was. Returns a description of the change.
pub(super) fn change_step(
    state: &mut State,
    choice: &StepChoice,
    adaptive: bool,
) -> Option<String> {
    let before_s = state.time_step_s;
    let step_s = match (choice.given, adaptive) {
        (true, _) => choice.step_s,
        (false, true) => before_s,
        (false, false) => choice.step_s.min(before_s),
    };
    if step_s > before_s {
        look_anew_for_near(state);
    }
    state.time_step_s = step_s;
    (step_s != before_s).then(|| change(before_s, step_s))
}

/// Requests a new neighbour search before the next step: the present lists are valid for steps of
/// the present size.
pub(super) fn look_anew_for_near(state: &mut State) {
    if let Some(contacts) = &mut state.contacts {
        contacts.search_all();
    }
}

pub(super) fn change(before_s: f64, after_s: f64) -> String {
    format!("time step {before_s:.4e} s -> {after_s:.4e} s")
}

/// The event of a new time step.
pub(super) fn new_step<'a>(state: &State, cause: &'a str, detail: &'a str) -> Event<'a> {
    of_all(state, "time_step", cause, detail)
}

/// An event without a bond and a position.
fn of_all<'a>(state: &State, kind: &'a str, cause: &'a str, detail: &'a str) -> Event<'a> {
    Event {
        step: state.steps,
        time_s: state.time_s,
        kind,
        bond: None,
        particle_a: None,
        particle_b: None,
        position_m: None,
        cause,
        energy_j: None,
        detail,
    }
}
