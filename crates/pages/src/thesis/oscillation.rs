//! Two bonded particles, pulled and released (Platzer 2022, fig. 47).

use dem_run::{plan, step};
use dem_scene::read_bodies;
use serde_json::json;

use super::samples::scene;
use crate::bench::{Bench, Failed, keep};

/// Damping ratios: undamped, damped, critically damped, overdamped.
pub(crate) const DAMPING: [&str; 4] = ["0", "0.2", "1", "2"];
pub(crate) const FILE: &str = "oscillation.json";

pub(crate) fn sets(damping: &str) -> Vec<String> {
    vec![format!("bonds.cake.damping={{damping_ratio={damping}}}")]
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    let of_damping = DAMPING.into_iter().zip(curves()?);
    let all = of_damping.map(|(damping, points)| json!({ "damping": damping, "points": points }));
    keep(&bench.folder.join(FILE), &all.collect())
}

/// Time, s, and elongation, m, for each damping.
pub(crate) fn curves() -> Result<Vec<Vec<[f64; 2]>>, Failed> {
    let mut all = Vec::new();
    for damping in DAMPING {
        let scene = scene("oscillation", None, &sets(damping))?;
        let mut state = plan(&scene, read_bodies(&scene)?, 1, false)?.state;
        let distance_m = |state: &dem_run::State| {
            let [a, b] = [0, 1].map(|at| state.particles.poses[at].place());
            (b - a).norm()
        };
        let start_m = distance_m(&state);
        let mut points = Vec::new();
        while state.time_s < scene.run.end_time_s {
            step(&mut state);
            points.push([state.time_s, distance_m(&state) - start_m]);
        }
        all.push(points);
    }
    Ok(all)
}
