//! Events of a run (broken bonds, replaced bodies, changes of the plan) as one CSV table that
//! grows.
//!
//! Columns: see [`Event::COLUMNS`]. Values that do not apply to an event are empty.

use super::columns::{Column, known, lines};
use super::growing::field;
use dem_io::text::exact;

/// One event.
#[derive(Debug, Clone, PartialEq)]
pub struct Event<'a> {
    /// Number of the time step.
    pub step: u64,
    /// Simulated time, s.
    pub time_s: f64,
    /// Type of the event: `bond_broken`.
    pub kind: &'a str,
    /// The bond concerned.
    pub bond: Option<u64>,
    /// The first particle concerned.
    pub particle_a: Option<u64>,
    /// The second one.
    pub particle_b: Option<u64>,
    /// Position, m.
    pub position_m: Option<[f64; 3]>,
    /// Cause: `tension`. May be empty.
    pub cause: &'a str,
    /// Released energy, J.
    pub energy_j: Option<f64>,
    /// Further human-readable details. May be empty.
    pub detail: &'a str,
}

impl Event<'_> {
    /// The columns of its table.
    pub const COLUMNS: [Column<Self>; 12] = [
        ("step", |row| row.step.to_string()),
        ("time_s", |row| exact(row.time_s)),
        ("event", |row| field(row.kind)),
        ("bond", |row| known(row.bond)),
        ("particle_a", |row| known(row.particle_a)),
        ("particle_b", |row| known(row.particle_b)),
        ("x_m", |row| place(row, 0)),
        ("y_m", |row| place(row, 1)),
        ("z_m", |row| place(row, 2)),
        ("cause", |row| field(row.cause)),
        ("energy_j", |row| known(row.energy_j.map(exact))),
        ("detail", |row| field(row.detail)),
    ];
}

/// Lines of the table of events.
pub fn event_lines<'a>(events: impl IntoIterator<Item = Event<'a>>) -> String {
    lines(&Event::COLUMNS, events)
}

fn place(event: &Event<'_>, axis: usize) -> String {
    known(event.position_m.map(|place_m| exact(place_m[axis])))
}
