//! Events of a run (broken bonds, replaced bodies, changes of the plan) as one CSV table that
//! grows.
//!
//! Columns: see [`Event::COLUMNS`]. Values that do not apply to an event are empty.

use std::io::BufRead;
use std::path::Path;

use super::columns::{Column, known, lines};
use super::growing::{field, fields};
use dem_io::diagnostic::{Diagnostic, Result};
use dem_io::lines::{Lines, float, on_line};
use dem_io::open_input;
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
    /// Strain rate that determined the strength of a bond, 1/s, and the factor on it.
    pub strengthened: Option<[f64; 2]>,
}

impl Event<'_> {
    /// The columns of its table.
    pub const COLUMNS: [Column<Self>; 14] = [
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
        (STRENGTHENED[0], |row| strengthened(row, 0)),
        (STRENGTHENED[1], |row| strengthened(row, 1)),
    ];
}

/// Columns of the strain rate that determined the strength of a bond, and of the factor on it.
const STRENGTHENED: [&str; 2] = ["strain_rate_1_s", "dynamic_increase_factor"];

/// Lines of the table of events.
pub fn event_lines<'a>(events: impl IntoIterator<Item = Event<'a>>) -> String {
    lines(&Event::COLUMNS, events)
}

fn place(event: &Event<'_>, axis: usize) -> String {
    known(event.position_m.map(|place_m| exact(place_m[axis])))
}

fn strengthened(event: &Event<'_>, which: usize) -> String {
    known(event.strengthened.map(|both| exact(both[which])))
}

/// Strain rates, 1/s, and factors on the strengths of the bonds that have broken with them, from
/// the table at `path`.
pub fn read_strengthened(path: &Path) -> Result<Vec<[f64; 2]>> {
    let within = |error: Diagnostic| error.within(&path.display().to_string());
    read_lines(&mut open_input(path)?).map_err(within)
}

fn read_lines(input: &mut dyn BufRead) -> Result<Vec<[f64; 2]>> {
    let mut lines = Lines::new(input);
    let (_, first) = lines.next_line()?.unwrap_or((1, ""));
    let names = fields(first);
    let places = STRENGTHENED.map(|name| names.iter().position(|known| known == name));
    let [Some(rate), Some(factor)] = places else {
        return Ok(Vec::new());
    };
    let mut found = Vec::new();
    while let Some((number, line)) = lines.next_line()? {
        let fields = fields(line);
        let text = |at: usize| {
            fields
                .get(at)
                .map(String::as_str)
                .filter(|text| !text.is_empty())
        };
        if let (Some(rate), Some(factor)) = (text(rate), text(factor)) {
            let read = |text, name| float(Some(text), name).map_err(|error| on_line(number, error));
            found.push([read(rate, STRENGTHENED[0])?, read(factor, STRENGTHENED[1])?]);
        }
    }
    Ok(found)
}
