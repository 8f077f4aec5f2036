//! The times at which fragments are written, and their data.

use dem_io::Result;

use super::files::Files;
use super::progress::Progress;
use crate::output::fragments::rows;
use dem_engine::stages::clumps::synchronous;
use dem_engine::stages::totals::synchronous_motions;
use dem_engine::state::State;
use dem_engine::state::clusters::fragments;

/// Besides at the frames, fragments are written when their number has grown by one in this many.
/// While there are few, every new one is written, and the number of rows written for all splits
/// together is at most one more than this times the number of fragments at the end.
const GROWTH: u64 = 20;

impl Progress {
    /// Whether the number of fragments has grown enough since they were last written for them to be
    /// written again.
    pub(super) fn has_new_fragments(&self, state: &State) -> bool {
        let Some(clusters) = &state.clusters else {
            return false;
        };
        let written = self.fragments_written;
        clusters.living().count() as u64 > written + written / GROWTH
    }
}

/// Writes the position and motion of all fragments, if there are any.
pub(super) fn write_fragments(
    state: &State,
    progress: &mut Progress,
    files: &mut Files<'_>,
) -> Result<()> {
    let (Some(clusters), Some(file)) = (&state.clusters, &mut files.fragments) else {
        return Ok(());
    };
    let motions = synchronous_motions(state);
    let moving = synchronous(state);
    let now = Some((&motions[..], &moving[..]));
    let fragments = fragments(clusters, &state.particles, &state.clumps, now);
    progress.fragments_written = fragments.len() as u64;
    file.append(state.time_s, &rows(&fragments, &state.model))
}
