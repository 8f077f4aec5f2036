//! Output schedule of a run.

use dem_scene::Scene;
use serde::{Deserialize, Serialize};

use dem_engine::state::State;

/// Default number of rows of the time series.
const ROWS: f64 = 1000.0;

/// Number of particles and bonds from which the cost of a row matters: about that of four steps.
const LARGE: usize = 20_000;
/// Default smallest number of steps between two rows of a large scene.
const ROW_STEPS: f64 = 200.0;

/// Output intervals of a run, s, and its criterion for rest.
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

/// Number of the first of those times that is in the future.
pub(super) fn next(state: &State, every_s: f64) -> u64 {
    first_after(state.time_s + 0.5 * state.time_step_s, every_s)
}

/// Number of the first of the times 0, `every_s`, 2 `every_s`, ... after this one, s.
pub(super) fn first_after(time_s: f64, every_s: f64) -> u64 {
    ((time_s / every_s).floor() as u64).saturating_add(1)
}

impl OutputSchedule {
    /// For a scene planned with this step, with this number of particles and bonds.
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
