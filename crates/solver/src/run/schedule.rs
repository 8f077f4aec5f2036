//! When a run writes.

use dem_scene::Scene;
use serde::{Deserialize, Serialize};

use crate::state::State;

/// Rows of the time series unless asked otherwise.
const ROWS: f64 = 1000.0;

/// Particles and bonds of a scene in which a row costs time worth saving: as much as about four
/// steps.
const LARGE: usize = 20_000;
/// Steps between two rows of a large scene, at least, unless asked otherwise.
const ROW_STEPS: f64 = 200.0;

/// How often a run writes, s, and what it takes for rest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct OutputSchedule {
    pub(super) row_s: f64,
    pub(super) frame_s: Option<f64>,
    pub(super) checkpoint_s: Option<f64>,
    pub(super) rest: Option<f64>,
}

/// Whether the next of the times 0, `every_s`, 2 `every_s`, ... has been reached.
pub(super) fn due(state: &State, every_s: f64, next: u64) -> bool {
    state.time_s + 0.5 * state.time_step_s >= next as f64 * every_s
}

/// Number of the first of those times that is still to come.
pub(super) fn next(state: &State, every_s: f64) -> u64 {
    first_after(state.time_s + 0.5 * state.time_step_s, every_s)
}

/// Number of the first of the times 0, `every_s`, 2 `every_s`, ... after this one, s.
pub(super) fn first_after(time_s: f64, every_s: f64) -> u64 {
    ((time_s / every_s).floor() as u64).saturating_add(1)
}

impl OutputSchedule {
    /// Of a scene planned with this step, with so many particles and bonds.
    pub(super) fn of(scene: &Scene, step_s: f64, size: usize) -> Self {
        let output = scene.output.clone().unwrap_or_default();
        let apart = if size > LARGE {
            ROW_STEPS * step_s
        } else {
            0.0
        };
        let usual = (scene.run.end_time_s / ROWS).max(apart);
        Self {
            row_s: output.series_s.unwrap_or(usual),
            frame_s: output.frames_s,
            checkpoint_s: output.checkpoint_s,
            rest: scene.run.rest_energy_ratio,
        }
    }
}
