//! The table of events, `events.csv`.

use dem_io::Result;
use dem_io::text::exact;
use dem_results::columns::header;
use dem_results::folder::names;
use dem_results::{Event, Table, event_lines};

use super::{Changes, Opening, Output, Saved};
use crate::new_step::NewStep;
use dem_engine::state::State;
use dem_engine::state::bodies::{PlacedBody, bond_of_file};
use dem_engine::state::clusters::{Cluster, Split};
use dem_engine::state::events::{BrokenInto, PopulationEvent, STARTS_BONDED};
use dem_physics::bond::failure::Cause;

/// Largest number of fragments named in the text of a split.
const NAMED: usize = 8;

struct EventTable(Table);

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    let table = opening.table(
        &opening.folder.file(names::EVENTS),
        &header(&Event::COLUMNS),
    )?;
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
            table.append(&event_lines([of_all(state, "time_step", cause, detail)]))?;
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
            // The rate raises no compressive strength.
            strengthened: (broken.strengthened).filter(|_| broken.cause != Cause::Compression),
        };
        table.append(&event_lines([event]))?;
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
    let events = (details.iter()).map(|detail| of_all(state, "split", "", detail));
    table.append(&event_lines(events))
}

/// Human-readable fragments of one present or former cluster:
/// `fragment 3 -> 7, 8 (1204 + 38 particles)`. The largest are first, and only some of many are
/// named.
pub fn split_text(split: &Split, history: &[Cluster]) -> String {
    let particles = |id: u32| history[id as usize].particles;
    let mut children = split.children.clone();
    // The sort is stable.
    children.sort_by_key(|id| std::cmp::Reverse(particles(*id)));
    let (named, others) = children.split_at(children.len().min(NAMED));
    let ids: Vec<String> = named.iter().map(u32::to_string).collect();
    let counts: Vec<String> = named.iter().map(|id| particles(*id).to_string()).collect();
    let mut text = format!(
        "fragment {} -> {} ({} particles)",
        split.parent,
        ids.join(", "),
        counts.join(" + ")
    );
    if !others.is_empty() {
        let count: u64 = others.iter().map(|id| u64::from(particles(*id))).sum();
        let s = if count == 1 { "" } else { "s" };
        text += &format!(" and {} more ({count} particle{s})", others.len());
    }
    text
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
    let events = &state.scratch.events;
    for one in &events.population {
        let (kind, cause) = kind_and_cause(one);
        table.append(&event_lines([Event {
            step: events.step,
            time_s: events.time_s,
            position_m: Some(place_m(one)),
            energy_j: energy_j(one),
            ..of_all(state, kind, cause, &detail(one))
        }]))?;
    }
    Ok(())
}

fn kind_and_cause(event: &PopulationEvent) -> (&'static str, &str) {
    use PopulationEvent::{Broken, Came, Left, Replaced, Restored};
    match event {
        Replaced { cause, .. } if *cause == STARTS_BONDED => ("bonded", cause),
        Replaced { cause, .. } => ("replaced", cause),
        Broken { .. } => ("replaced", "specific_energy"),
        Restored { .. } => ("restored", "quiet"),
        Came { inlet, .. } => ("fed", inlet),
        Left { outlet, .. } => ("discharged", outlet),
    }
}

fn place_m(event: &PopulationEvent) -> [f64; 3] {
    use PopulationEvent::{Broken, Came, Left, Replaced, Restored};
    let (Replaced { place_m, .. }
    | Broken { place_m, .. }
    | Restored { place_m, .. }
    | Came { place_m, .. }
    | Left { place_m, .. }) = event;
    *place_m
}

/// Kinetic energy that a replacement added, or energy that a restored fragment lost, J.
fn energy_j(event: &PopulationEvent) -> Option<f64> {
    use PopulationEvent::{Broken, Replaced, Restored};
    match event {
        Replaced { kinetic_j, .. } | Broken { kinetic_j, .. } => Some(kinetic_j[1] - kinetic_j[0]),
        Restored { lost_j, .. } => Some(*lost_j),
        _ => None,
    }
}

fn detail(event: &PopulationEvent) -> String {
    match event {
        PopulationEvent::Replaced {
            cluster,
            body,
            mass_kg,
            momentum_n_s,
            kinetic_j,
            ..
        } => format!(
            "fragment {cluster} ({body}): {}",
            kept(mass_kg, momentum_n_s, kinetic_j)
        ),
        PopulationEvent::Broken {
            cluster,
            body,
            into,
            daughters: (of_body, count),
            specific_j_kg,
            mass_kg,
            momentum_n_s,
            kinetic_j,
            ..
        } => format!(
            "fragment {cluster} ({body}): {} J/kg; {}; {count} daughters; {}",
            exact(*specific_j_kg),
            match into {
                BrokenInto::Class(number) => format!("class {} ({of_body})", number + 1),
                BrokenInto::Law { t10, fines_kg } => format!("t10 {t10:.4}; fines {fines_kg:e} kg"),
            },
            kept(mass_kg, momentum_n_s, kinetic_j)
        ),
        PopulationEvent::Restored {
            cluster,
            body,
            particles,
            ..
        } => format!("fragment {cluster} ({body}): {particles} particles"),
        PopulationEvent::Came { cluster, body, .. } => format!("fragment {cluster} ({body})"),
        PopulationEvent::Left {
            cluster,
            body,
            mass_kg,
            ..
        } => format!("fragment {cluster} ({body}): {mass_kg:e} kg"),
    }
}

/// The spheres of bodies bonded in part that were released or joined a rigid part in this step.
fn write_zones(state: &State, table: &mut Table) -> Result<()> {
    for news in &state.scratch.events.zones {
        let plural = if news.particles == 1 { "" } else { "s" };
        table.append(&event_lines([Event {
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
        table.append(&event_lines([Event {
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
        strengthened: None,
    }
}
