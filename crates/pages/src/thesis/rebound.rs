//! Rebound from a level plate over the damping of the bonds (Platzer 2022, 4.5.1.7 and 4.5.2.2).

use std::path::Path;

use dem_run::{plan, step};
use dem_scene::read_bodies;
use serde_json::{Value, json};

use super::samples::{COARSE, PACKINGS, Sample, scene};
use crate::bench::{Bench, Failed};

/// Damping of the bonds: in the table and the names of the results, and in the scene. Of eq. 7 it
/// damps the translation by a coefficient d, and of eq. 9 the rotation whatever d is.
pub(crate) const DAMPING: [(&str, &str); 13] = [
    ("0 of critical", "damping_ratio=0"),
    ("0.1 of critical", "damping_ratio=0.1"),
    ("0.2 of critical", "damping_ratio=0.2"),
    ("0.4 of critical", "damping_ratio=0.4"),
    ("0.6 of critical", "damping_ratio=0.6"),
    ("1 of critical", "damping_ratio=1"),
    ("2 of critical", "damping_ratio=2"),
    ("eq. 9 alone", "damping_coefficient=0,torque_factor=1"),
    (
        "eqs. 7 and 9, 0.1 N s/m",
        "damping_coefficient=\"0.1 N s/m\",torque_factor=1",
    ),
    (
        "eqs. 7 and 9, 0.6 N s/m",
        "damping_coefficient=\"0.6 N s/m\",torque_factor=1",
    ),
    (
        "eqs. 7 and 9, 1 N s/m",
        "damping_coefficient=\"1 N s/m\",torque_factor=1",
    ),
    (
        "eqs. 7 and 9, 2 N s/m",
        "damping_coefficient=\"2 N s/m\",torque_factor=1",
    ),
    (
        "eqs. 7 and 9, 5 N s/m",
        "damping_coefficient=\"5 N s/m\",torque_factor=1",
    ),
];
/// The sample is clear of the plate by then.
const END_TIME: &str = "30 ms";
const GRAVITY_M_S2: f64 = 9.81;

pub(crate) fn name(damping: &str, seed: u32) -> String {
    format!("rebound-2-{}-{seed}", damping.replace([' ', '/'], "_"))
}

/// Settings of the scene of drops: level plate, bonds that do not break.
pub(crate) fn sets(damping: &str) -> Vec<String> {
    let mut sets = COARSE.table.unbreakable_sets();
    sets.extend([
        format!("bonds.cake.damping={{{damping}}}"),
        "walls.plate.rotation.angle=\"0 deg\"".to_owned(),
        "bodies.sample.position=[\"-90 mm\",\"-15 mm\",\"1 mm\"]".to_owned(),
        format!("run.end_time=\"{END_TIME}\""),
    ]);
    sets
}

pub(crate) fn compute(bench: &Bench) -> Result<(), Failed> {
    for (label, damping) in DAMPING {
        for seed in 1..=PACKINGS {
            let name = name(label, seed);
            let sample = Sample { seed, ..COARSE };
            sample.keep(bench, &name, |body| rebound(body, &sets(damping)))?;
        }
    }
    Ok(())
}

/// Height to which the centre of mass rises by its speed at the end, above its height there.
fn rebound(body: &Path, sets: &[String]) -> Result<Value, Failed> {
    let scene = scene("drop", Some(body), sets)?;
    let mut state = plan(&scene, read_bodies(&scene)?, 1, false)?.state;
    let centre = |state: &dem_run::State| {
        let both = state.particles.motions.iter().zip(&state.particles.poses);
        let sums = both.fold([0.0; 3], |[m, z, v], (motion, pose)| {
            let mass_kg = 1.0 / motion.inverse_mass;
            [
                m + mass_kg,
                z + mass_kg * pose.position_m[2],
                v + mass_kg * motion.velocity_m_s[2],
            ]
        });
        [sums[1] / sums[0], sums[2] / sums[0]]
    };
    let [start_m, impact_m_s] = centre(&state);
    while state.time_s < scene.run.end_time_s {
        step(&mut state);
    }
    let [end_m, speed_m_s] = centre(&state);
    let rise_m = end_m - start_m + speed_m_s.max(0.0).powi(2) / (2.0 * GRAVITY_M_S2);
    let fall_m = impact_m_s.powi(2) / (2.0 * GRAVITY_M_S2);
    Ok(json!({ "fraction": rise_m / fall_m }))
}
