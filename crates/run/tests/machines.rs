//! Walls that swing, go round a circle or gyrate, and what they carry and hit.

mod carried;
mod hit;
mod planned;

use dem_engine::state::State;
use dem_engine::step::step;

/// Steps of a run, up to this time.
fn go_until(state: &mut State, time_s: f64) {
    while state.time_s < time_s {
        step(state);
    }
}
