//! The steps of an exported run.

use dem_scene::Scene;

use crate::check::limit::safe_step;
use crate::plan::Plan;

/// Number of steps of a run. Damping of bonds in LAMMPS takes velocities half a step old, which
/// shortens the largest stable step.
pub(super) fn steps(scene: &Scene, plan: &Plan) -> u64 {
    let omega_rad_s = plan.step.limit.omega_rad_s;
    let stable_s = safe_step(omega_rad_s * omega_rad_s, plan.state.damping_rate_1_s);
    let step_s = match plan.state.damping_rate_1_s > 0.0 {
        true => plan.step.step_s.min(scene.run.safety_factor * stable_s),
        false => plan.step.step_s,
    };
    (scene.run.end_time_s / step_s).ceil() as u64
}

/// The time step, s: the end of the run is that of the last step.
pub(super) fn step_s(scene: &Scene, plan: &Plan) -> f64 {
    scene.run.end_time_s / steps(scene, plan) as f64
}
