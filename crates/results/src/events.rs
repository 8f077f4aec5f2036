//! Events of a run (broken bonds, replaced bodies, changes of the plan) as one CSV table that
//! grows.
//!
//! Columns: see [`COLUMNS`]. Values that do not apply to an event are empty. Every number reads
//! back as the same bits.

use std::fmt::{Display, Write};

use super::growing::field;

/// The first line of the file.
pub const COLUMNS: &str =
    "step,time_s,event,bond,particle_a,particle_b,x_m,y_m,z_m,cause,energy_j,detail";

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

/// Lines of the table of events.
pub fn event_lines(events: &[Event<'_>]) -> String {
    events.iter().map(row).collect()
}

fn row(event: &Event<'_>) -> String {
    let [x, y, z] = event.position_m.map_or([None; 3], |place| place.map(Some));
    let mut row = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        row,
        "{},{},{},{},{},{},{},{},{},{},{},{}",
        event.step,
        exact(Some(event.time_s)),
        field(event.kind),
        known(event.bond),
        known(event.particle_a),
        known(event.particle_b),
        exact(x),
        exact(y),
        exact(z),
        field(event.cause),
        exact(event.energy_j),
        field(event.detail),
    );
    row
}

fn known(value: Option<impl Display>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}

fn exact(value: Option<f64>) -> String {
    value.map(dem_io::text::exact).unwrap_or_default()
}
