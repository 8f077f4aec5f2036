//! Events of a run (bonds that break, bodies that are replaced, changes of the plan) as one CSV
//! table that grows.
//!
//! Columns: see [`COLUMNS`]. What does not apply to an event is left empty. Every number reads back
//! as the same bits.

use std::fmt::{Display, Write};
use std::path::Path;

use super::growing::{GrowingTable, field};
use dem_io::diagnostic::Result;

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
    /// What happened: `bond_broken`.
    pub kind: &'a str,
    /// The bond that it happened to.
    pub bond: Option<u64>,
    /// The first particle that it happened to.
    pub particle_a: Option<u64>,
    /// The second one.
    pub particle_b: Option<u64>,
    /// Where, m.
    pub position_m: Option<[f64; 3]>,
    /// Why: `tension`. May be empty.
    pub cause: &'a str,
    /// Energy that was released, J.
    pub energy_j: Option<f64>,
    /// Anything more, for a person. May be empty.
    pub detail: &'a str,
}

/// The file of the events.
#[derive(Debug)]
pub struct EventFile {
    table: GrowingTable,
}

impl EventFile {
    /// A new file without events. Replaces what stood there.
    ///
    /// # Errors
    /// Missing folder, no permission, full disk (all exit code 1).
    pub fn create(path: &Path) -> Result<Self> {
        Ok(Self {
            table: GrowingTable::create(path, COLUMNS)?,
        })
    }

    /// The file of an interrupted run, cut back to the `length_bytes` that it had at its
    /// checkpoint.
    ///
    /// # Errors
    /// It has other columns, is shorter, or has no row that ends there (all exit code 2); it cannot
    /// be opened or written to (exit code 1).
    pub fn continue_at(path: &Path, length_bytes: u64) -> Result<Self> {
        Ok(Self {
            table: GrowingTable::continue_at(path, COLUMNS, length_bytes)?,
        })
    }

    /// Appends events, such as all of one step. They are in the file when this returns.
    ///
    /// # Errors
    /// Full disk (exit code 1): the events before are kept.
    pub fn append(&mut self, events: &[Event<'_>]) -> Result<()> {
        if events.is_empty() {
            return Ok(());
        }
        self.table
            .append(&events.iter().map(row).collect::<String>())
    }

    /// Length of the file: what a checkpoint keeps for [`EventFile::continue_at`].
    pub fn length_bytes(&self) -> u64 {
        self.table.length_bytes()
    }

    /// Waits until all events are on the disk, where a power failure leaves them. To be called
    /// before a checkpoint is written that counts on them.
    ///
    /// # Errors
    /// Full or broken disk (exit code 1).
    pub fn sync(&self) -> Result<()> {
        self.table.sync()
    }
}

fn row(event: &Event<'_>) -> String {
    let [x, y, z] = event.position_m.map_or([None; 3], |place| place.map(Some));
    let mut row = String::new();
    // Writing to a text cannot fail.
    let _ = writeln!(
        row,
        "{},{:e},{},{},{},{},{},{},{},{},{},{}",
        event.step,
        event.time_s,
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
    value.map(dem_io::vtk::exact).unwrap_or_default()
}
