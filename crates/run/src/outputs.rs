//! The files of results that grow during a run, as one list.

mod discharge;
pub mod event_table;
pub mod fragments;
pub(super) mod frames;
pub(super) mod list;
mod picture_order;
pub(super) mod pictures;
pub(super) mod series;

use std::path::Path;

use dem_io::{Diagnostic, Result};
use dem_results::{ResultsFolder, Table};
use dem_scene::Scene;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use self::picture_order::Order;
use super::new_step::NewStep;
use super::progress::Progress;
use crate::outputs::frames::order::FrameOrder;
use crate::outputs::frames::walls::WallOutput;
use dem_engine::Balance;
use dem_engine::state::State;
use dem_engine::state::bodies::PlacedBody;
use dem_plan::measure::Probe;

/// A file of results that grows during a run, or several of one kind.
pub(super) trait Output {
    /// Records what has broken in the first half of a step.
    fn note_breakage(&mut self, _state: &State, _bodies: &[PlacedBody]) -> Result<()> {
        Ok(())
    }

    /// Whether it is due at an interval of its own.
    fn is_due(&self, _state: &State) -> bool {
        false
    }

    /// Writes what is due between the two halves of a step.
    fn write(&mut self, _now: &Moment<'_>) -> Result<()> {
        Ok(())
    }

    /// Records what has changed in the second half of a step.
    fn note_changes(&mut self, _changes: &Changes<'_>) -> Result<()> {
        Ok(())
    }

    /// Waits until it is safe on the disk, and tells where it stands.
    fn save(&self) -> Result<Saved>;

    /// A note on it in this state, the last of the run.
    fn note(&self, _state: &State) -> Option<String> {
        None
    }
}

/// The outputs of a run, with their names.
pub(super) type Outputs = Vec<(&'static str, Box<dyn Output>)>;

/// Flushes all files to the disk, and records where they stand and their check sums.
pub(super) fn save_outputs(
    outputs: &Outputs,
    folder: &Path,
    progress: &mut Progress,
) -> Result<()> {
    for (name, output) in outputs {
        let saved = output.save()?;
        let name = (*name).to_owned();
        progress.positions.insert(name, saved.position);
        for (file, bytes) in &saved.files {
            if bytes.is_some() || !progress.sums.has(file) {
                progress.sums.update(folder, file, *bytes)?;
            }
        }
    }
    Ok(())
}

/// A run whose files are opened.
pub(super) struct Opening<'a> {
    /// The output to be opened.
    pub(super) name: &'static str,
    pub(super) folder: &'a ResultsFolder,
    pub(super) scene: &'a Scene,
    pub(super) state: &'a State,
    pub(super) bodies: &'a [PlacedBody],
    pub(super) probes: &'a [Probe],
    pub(super) start: &'a Start,
    /// None: a new run.
    pub(super) continued: Option<&'a Progress>,
}

/// What frames and pictures show of the state in which a run, continued or not, began.
pub(super) struct Start {
    order: FrameOrder,
    walls: WallOutput,
    /// None: no pictures.
    pictures: Option<Order>,
}

impl Start {
    pub(super) fn of(scene: &Scene, start: &State, bodies: &[PlacedBody]) -> Self {
        Self {
            order: FrameOrder::new(bodies, start),
            walls: WallOutput::of(start),
            pictures: Order::of(scene, start, bodies),
        }
    }
}

impl Opening<'_> {
    /// Where the output stood. None: a new run.
    fn position<T: Default + DeserializeOwned>(&self) -> Result<Option<T>> {
        let read = |progress| position(progress, self.name);
        self.continued.map(read).transpose()
    }

    /// The table in this file with this first line.
    fn table(&self, path: &Path, columns: &str) -> Result<Table> {
        let Some(end) = self.position::<TableEnd>()? else {
            return Table::create(path, columns);
        };
        let mut table = Table::continue_at(path, columns, end.bytes)?;
        table.append(&end.held)?;
        Ok(table)
    }
}

/// Where the output of this name stood at a checkpoint.
pub(super) fn position<T: Default + DeserializeOwned>(
    progress: &Progress,
    name: &str,
) -> Result<T> {
    let Some(bytes) = progress.positions.get(name) else {
        return Ok(T::default());
    };
    postcard::from_bytes(bytes).map_err(|error| {
        let remedy = "start the run again, without --resume";
        Diagnostic::input("checkpoint", format!("{name}: {error}"), remedy)
    })
}

/// Where an output stands, for the checkpoint.
pub(super) struct Saved {
    position: Vec<u8>,
    /// Names of its files in the folder of results, and the lengths that a continued run keeps of
    /// them. None: all of a file that does not change any more.
    files: Vec<(String, Option<u64>)>,
}

impl Saved {
    fn new(position: &impl Serialize, files: Vec<(String, Option<u64>)>) -> Result<Self> {
        let position = postcard::to_stdvec(position)
            .map_err(|error| Diagnostic::failed("checkpoint", error.to_string(), ""))?;
        Ok(Self { position, files })
    }

    /// Of a table that has been flushed to the disk, with `more` than its end.
    fn of_table(table: &Table, more: &impl Serialize) -> Result<Self> {
        table.sync()?;
        let (bytes, held) = (table.length_bytes(), table.held().to_owned());
        let files = vec![(table.name(), Some(bytes))];
        Self::new(&(TableEnd { bytes, held }, more), files)
    }
}

/// Where a table ends.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
struct TableEnd {
    bytes: u64,
    /// Rows after them that only a continued run shows.
    held: String,
}

/// A moment between the two halves of a step, where everything can be measured.
pub(super) struct Moment<'a> {
    pub(super) state: &'a State,
    pub(super) bodies: &'a [PlacedBody],
    /// Energies, and values of the measures, of a row of the time series. None: it is not due.
    pub(super) row: Option<(&'a Balance, &'a [f64])>,
    /// A frame is due.
    pub(super) is_frame: bool,
    /// The run ends.
    pub(super) is_last: bool,
}

/// What has changed in the second half of a step.
pub(super) struct Changes<'a> {
    pub(super) state: &'a State,
    pub(super) bodies: &'a [PlacedBody],
    /// Bodies have been added, removed or replaced, so that particles have other numbers.
    pub(super) has_other_bodies: bool,
    pub(super) new_steps: &'a [NewStep],
    /// The run has ended: only a continued one shows it.
    pub(super) is_after_end: bool,
}
