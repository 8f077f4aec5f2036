//! New time steps.

use dem_engine::state::State;
use dem_plan::time_step::StepChoice;

/// A new time step: its cause, and a description of the change.
#[derive(Debug, Clone)]
pub(super) struct NewStep {
    pub(super) cause: &'static str,
    pub(super) detail: String,
}

/// Takes the time step of the scene in a resumed run: a given step, or one smaller than before; an
/// adaptive step stays as it was. None: it is the same as before.
pub(super) fn change_step(
    state: &mut State,
    choice: &StepChoice,
    adaptive: bool,
) -> Option<NewStep> {
    let before_s = state.time_step_s;
    let step_s = match (choice.given, adaptive) {
        (true, _) => choice.step_s,
        (false, true) => before_s,
        (false, false) => choice.step_s.min(before_s),
    };
    if step_s > before_s {
        look_anew_for_near(state);
    }
    state.time_step_s = step_s;
    (step_s != before_s).then(|| NewStep {
        cause: "resumed",
        detail: change(before_s, step_s),
    })
}

/// Requests a new neighbour search before the next step: the present lists are valid for steps of
/// the present size.
pub(super) fn look_anew_for_near(state: &mut State) {
    if let Some(contacts) = &mut state.contacts {
        contacts.search_all();
    }
}

pub(super) fn change(before_s: f64, after_s: f64) -> String {
    format!("time step {before_s:.4e} s -> {after_s:.4e} s")
}
