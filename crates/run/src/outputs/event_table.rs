//! The table of events, `events.csv`.

use dem_io::Result;
use dem_io::text::exact;
use dem_results::{EVENT_COLUMNS, Event, Table, event_lines};

use super::{Changes, Opening, Output, Saved};
use crate::new_step::NewStep;
use crate::output::fragments::split_text;
use dem_engine::state::State;
use dem_engine::state::bodies::{PlacedBody, bond_of_file};
use dem_engine::state::events::{PopulationEvent, STARTS_BONDED};

struct EventTable(Table);

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let table = opening.table(&opening.folder.events(), EVENT_COLUMNS)?;
    Ok(Some(Box::new(EventTable(table))))
}

impl Output for EventTable {
    fn note_breakage(&mut self, state: &State, bodies: &[PlacedBody]) -> Result<()> {
        write_breaks(state, bodies, &mut self.0)?;
        write_splits(state, &mut self.0)
    }

    fn note_changes(&mut self, changes: &Changes<'_>) -> Result<()> {
        let (state, table) = (changes.state, &mut self.0);
        if changes.is_after_end {
            table.hold();
        }
        write_population(state, table)?;
        write_zones(state, table)?;
        write_sleep(state, table)?;
        for NewStep { cause, detail } in changes.new_steps {
            table.append(&event_lines(&[of_all(state, "time_step", cause, detail)]))?;
        }
        Ok(())
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.0, &())
    }
}

/// The bonds that broke in this step, by the numbers of the body's file.
fn write_breaks(state: &State, bodies: &[PlacedBody], table: &mut Table) -> Result<()> {
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
        table.append(&event_lines(&[event]))?;
    }
    Ok(())
}

/// The clusters that were found in pieces in this step.
fn write_splits(state: &State, table: &mut Table) -> Result<()> {
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
    table.append(&event_lines(&events))
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
fn write_population(state: &State, table: &mut Table) -> Result<()> {
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
        table.append(&event_lines(&[Event {
            step,
            time_s,
            position_m: Some(*place_m),
            energy_j,
            ..of_all(state, kind, cause, &detail)
        }]))?;
    }
    Ok(())
}

/// The spheres of bodies bonded in part that were released or joined a rigid part in this step.
fn write_zones(state: &State, table: &mut Table) -> Result<()> {
    for news in &state.scratch.events.zones {
        let plural = if news.particles == 1 { "" } else { "s" };
        table.append(&event_lines(&[Event {
            step: news.step,
            time_s: news.time_s,
            energy_j: Some(news.lost_j),
            ..of_all(
                state,
                news.kind,
                "region",
                &format!("{}: {} particle{plural}", news.body, news.particles),
            )
        }]))?;
    }
    Ok(())
}

/// The bodies that fell asleep or woke in this step.
fn write_sleep(state: &State, table: &mut Table) -> Result<()> {
    for news in &state.scratch.events.sleep {
        let plural = if news.bodies == 1 { "body" } else { "bodies" };
        table.append(&event_lines(&[Event {
            step: news.step,
            time_s: news.time_s,
            ..of_all(
                state,
                news.kind,
                news.cause,
                &format!("{} {plural}", news.bodies),
            )
        }]))?;
    }
    Ok(())
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
