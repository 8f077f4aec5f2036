//! When fragments are written, and what of them.

use dem_io::Result;

use super::files::Files;
use super::progress::Progress;
use crate::output::fragments::rows;
use crate::stages::clumps::synchronous;
use crate::stages::totals::synchronous_motions;
use crate::state::State;
use crate::state::clusters::fragments;

/// Besides the frames, fragments are written when there are more by one in so many: of few every
/// one shows, and the rows written for all splits together are at most one more than this times the
/// fragments at the end.
const GROWTH: u64 = 20;

impl Progress {
    /// Whether so many more fragments are there than when they were written last that they are to
    /// be written again.
    pub(super) fn has_new_fragments(&self, state: &State) -> bool {
        let Some(clusters) = &state.clusters else {
            return false;
        };
        let written = self.fragments_written;
        clusters.living().count() as u64 > written + written / GROWTH
    }
}

/// Writes how all fragments are and move, if there are any.
pub(super) fn write_fragments(
    state: &State,
    progress: &mut Progress,
    files: &mut Files<'_>,
) -> Result<()> {
    let (Some(clusters), Some(file)) = (&state.clusters, &mut files.fragments) else {
        return Ok(());
    };
    let motions = synchronous_motions(state);
    let moving = synchronous(&state.clumps, state.model.gravity_m_s2, state.time_step_s);
    let now = Some((&motions[..], &moving[..]));
    let fragments = fragments(clusters, &state.particles, &state.clumps, now);
    progress.fragments_written = fragments.len() as u64;
    file.append(state.time_s, &rows(&fragments))
}
