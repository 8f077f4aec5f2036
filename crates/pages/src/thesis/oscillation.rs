//! Two bonded particles, pulled and released (Platzer 2022, fig. 47).

use dem_run::{State, plan, step};
use dem_scene::read_bodies;

use super::samples::scene;
use crate::bench::Failed;

/// Damping ratios: undamped, damped, critically damped, overdamped.
pub(crate) const DAMPING: [&str; 4] = ["0", "0.2", "1", "2"];

pub(crate) fn sets(damping: &str) -> Vec<String> {
    vec![format!("bonds.cake.damping={{damping_ratio={damping}}}")]
}

/// Time, s, and elongation, m, for a damping.
pub(crate) fn curve(damping: &str) -> Result<Vec<[f64; 2]>, Failed> {
    let scene = scene("oscillation", None, &sets(damping))?;
    let mut state = plan(&scene, read_bodies(&scene)?, 1, false)?.state;
    let distance_m = |state: &State| {
        let [a, b] = [0, 1].map(|at| state.particles.poses[at].place());
        (b - a).norm()
    };
    let start_m = distance_m(&state);
    let mut points = Vec::new();
    while state.time_s < scene.run.end_time_s {
        step(&mut state);
        points.push([state.time_s, distance_m(&state) - start_m]);
    }
    Ok(points)
}
