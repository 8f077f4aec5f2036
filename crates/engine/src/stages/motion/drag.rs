//! Drag of a fluid at rest.
//!
//! Half of the loss of a step is booked with the force at its beginning, half with that at its end,
//! both with the velocity in the middle.

use crate::stages::stage::{Need, Stage};
use crate::state::State;

/// Drag of a fluid at rest.
pub(crate) const DRAG: Stage = Stage {
    bytes: |state| {
        let drag = state.drag.iter();
        drag.map(|drag| size_of_val(&drag.forces_n[..]) + size_of_val(&drag.lost_j[..]))
            .sum()
    },
    ..Stage::new("drag", |state, _| {
        Need::of(state.drag.is_some(), || "run.drag".to_owned(), "no drag")
    })
};

/// Adds the drag to the wrenches. Returns the number of particles on which it acts.
pub(crate) fn compute_drag(state: &mut State) -> usize {
    let Some(drag) = &mut state.drag else {
        return 0;
    };
    let half_s = 0.5 * state.previous_time_step_s;
    let p = &mut state.particles;
    for i in 0..p.free {
        let velocity = p.motions[i].velocity_m_s;
        for (k, v) in velocity.iter().enumerate() {
            let force_n = -drag.coefficient_n_s_m * v;
            drag.lost_j[i] -= half_s * (drag.forces_n[i][k] + force_n) * v;
            drag.forces_n[i][k] = force_n;
            p.wrenches[i].force_n[k] += force_n;
        }
    }
    p.free
}
