//! Stages of the step of a scene, those that are skipped, and the reasons.

use dem_scene::Scene;

use dem_engine::stages::stage::{Need, Stage};
use dem_engine::stages::watching::OUTPUT;
use dem_engine::state::State;
use dem_engine::step::{number_of, stages};

/// A stage of the step: active or skipped, and the reason.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedStage {
    /// The stage.
    pub stage: &'static Stage,
    /// Whether the scene needs it.
    pub needed: bool,
    /// The reason.
    pub why: String,
    /// Bytes of the arrays that only this stage needs, at the start.
    pub bytes: usize,
}

/// The stages of a step, active or skipped.
pub(super) fn planned_stages(state: &State, scene: &Scene) -> Vec<PlannedStage> {
    let stages = stages().iter().filter(|stage| ***stage != OUTPUT);
    let planned = stages.map(|stage| {
        let (needed, why) = match (stage.need)(state, scene) {
            Need::Needed(why) => (true, why),
            Need::LeftOut(why) => (false, why.to_owned()),
        };
        PlannedStage {
            stage,
            needed,
            why,
            bytes: (stage.bytes)(state),
        }
    });
    planned.collect()
}

/// Removes the stages from the step that the scene does not need.
pub(super) fn leave_out(stages: &[PlannedStage], state: &mut State) {
    for planned in stages.iter().filter(|planned| !planned.needed) {
        state.scratch.clock.leave_out(number_of(planned.stage));
    }
}
