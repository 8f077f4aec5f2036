//! Scenes from texts, and values read from them during the run.

use dem_run::{Plan, State, plan};
use dem_scene::{read_bodies, scene_from_text};
use nalgebra::Vector3;

/// The plan of a scene, for any time step in it.
pub(crate) fn planned(text: &str) -> Plan {
    let scene = scene_from_text(text, "verification.toml", &[]);
    let scene = scene.unwrap_or_else(|error| panic!("{error}: {text}"));
    let bodies = read_bodies(&scene).unwrap();
    plan(&scene, bodies, 1, true).unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// Its state before the first step.
pub(crate) fn started(text: &str) -> State {
    planned(text).state
}

/// Position of a particle at the time of the state, m.
pub(crate) fn place(state: &State, particle: usize) -> Vector3<f64> {
    state.particles.poses[particle].place()
}

/// Its velocity half a step before, m/s.
pub(crate) fn velocity(state: &State, particle: usize) -> Vector3<f64> {
    state.particles.motions[particle].velocity_m_s.into()
}

/// Its spin half a step before, rad/s.
pub(crate) fn spin(state: &State, particle: usize) -> Vector3<f64> {
    state.particles.motions[particle].spin_rad_s.into()
}
