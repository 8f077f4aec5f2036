//! The fragments at chosen moments, `fragments.csv`.

use dem_io::Result;
use dem_results::fragments::COLUMNS;
use dem_results::{Table, append_fragments};

use super::{Moment, Opening, Output, Saved, TableEnd};
use crate::output::fragments::rows;
use dem_engine::stages::clumps::motion::synchronous;
use dem_engine::stages::ledger::totals::synchronous_motions;
use dem_engine::state::clusters::fragments;

/// Besides at the frames, fragments are written when their number has grown by one in this many.
/// While there are few, every new one is written, and the number of rows written for all splits
/// together is at most one more than this times the number of fragments at the end.
const GROWTH: u64 = 20;

struct Fragments {
    table: Table,
    /// Number of fragments when they were written last.
    written: u64,
}

pub(super) fn open(opening: &Opening<'_>) -> Result<Option<Box<dyn Output>>> {
    if opening.state.clusters.is_none() {
        return Ok(None);
    }
    let position = opening.position::<(TableEnd, u64)>()?;
    Ok(Some(Box::new(Fragments {
        table: opening.table(&opening.folder.fragments(), COLUMNS)?,
        written: position.map_or(0, |(_, written)| written),
    })))
}

impl Output for Fragments {
    fn write(&mut self, now: &Moment<'_>) -> Result<()> {
        let state = now.state;
        let Some(clusters) = &state.clusters else {
            return Ok(());
        };
        let has_new = || clusters.living().count() as u64 > self.written + self.written / GROWTH;
        if !(now.is_frame || now.row.is_some() && has_new()) {
            return Ok(());
        }
        let motions = synchronous_motions(state);
        let moving = synchronous(state);
        let moving = Some((&motions[..], &moving[..]));
        let fragments = fragments(clusters, &state.particles, &state.clumps, moving);
        self.written = fragments.len() as u64;
        let rows = rows(&fragments, &state.model);
        append_fragments(&mut self.table, state.time_s, &rows)
    }

    fn save(&self) -> Result<Saved> {
        Saved::of_table(&self.table, &self.written)
    }
}
