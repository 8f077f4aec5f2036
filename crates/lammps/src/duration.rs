//! The steps of an exported run.

use dem_scene::Scene;

use dem_engine::check::limit::safe_step;
use dem_plan::Plan;

/// Frames of a scene that asks for none.
const FRAMES_UNASKED: u64 = 100;
/// Part of the time between two frames that rounding may add to the end.
const ROUNDING: f64 = 1e-6;

/// Steps between two frames: the last frame is that of the end.
pub(super) fn frame_every(scene: &Scene, plan: &Plan) -> u64 {
    frames_and_steps(scene, plan)[1]
}

/// Number of steps of a run.
pub(super) fn steps(scene: &Scene, plan: &Plan) -> u64 {
    let [frames, every] = frames_and_steps(scene, plan);
    frames * every
}

/// Number of frames after the first, and of steps between two of them. Damping of bonds in LAMMPS
/// takes velocities half a step old, which shortens the largest stable step.
fn frames_and_steps(scene: &Scene, plan: &Plan) -> [u64; 2] {
    let omega_rad_s = plan.step.limit.omega_rad_s;
    let stable_s = safe_step(omega_rad_s * omega_rad_s, plan.state.damping_rate_1_s);
    let longest_s = match plan.state.damping_rate_1_s > 0.0 {
        true => plan.step.step_s.min(scene.run.safety_factor * stable_s),
        false => plan.step.step_s,
    };
    let end_s = scene.run.end_time_s;
    let least = (end_s / longest_s).ceil().max(1.0) as u64;
    let asked_s = scene.output.as_ref().and_then(|output| output.frames_s);
    let asked = asked_s.map_or(FRAMES_UNASKED, |frames_s| {
        (end_s / frames_s - ROUNDING).ceil().max(1.0) as u64
    });
    let frames = asked.min(least);
    [frames, least.div_ceil(frames)]
}

/// The time step, s: the end of the run is that of the last step.
pub(super) fn step_s(scene: &Scene, plan: &Plan) -> f64 {
    scene.run.end_time_s / steps(scene, plan) as f64
}
