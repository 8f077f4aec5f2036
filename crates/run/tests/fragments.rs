//! Output of a run about fragments, and fragments extracted from it as bodies.

mod all;
mod bodies;
mod files;
mod pictures;
mod resume;
mod sizes;
mod strained;

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

use dem_io::Result;
use dem_results::Summary;
use dem_results::{Existing, ResultsFolder};
use dem_run::plan::{Plan, plan};
use dem_run::run::snapshot::Snapshot;
use dem_run::run::{RunSettings, run};
use dem_run::state::clusters::Clusters;
use dem_scene::Scene;
use dem_scene::scene_from_text;
use tempfile::TempDir;

use dem_scene::read_bodies;

/// Number of particles of the rod.
pub(crate) const PARTICLES: usize = 60;

/// A rod that spins until it bursts, and a pair that flies past and holds. Strengths scatter.
pub(crate) fn bursting() -> Scene {
    let mut particles = String::new();
    let mut bonds = String::new();
    for i in 0..PARTICLES {
        write!(particles, "[{}e-3, 0, 0, 1e-3],", 2 * i).unwrap();
        if i > 0 {
            write!(bonds, "[{}, {i}],", i - 1).unwrap();
        }
    }
    let text = format!(
        "version = 1
        [run]
        end_time = 5e-4
        safety_factor = 0.2
        seed = 5
        [materials.cake]
        density = 2050
        [bonds.brittle]
        young_modulus = 1e9
        poisson_ratio = 0.3
        failure = {{ tensile_strength = 2e6, weibull_modulus = 4 }}
        [bodies.rod]
        material = \"cake\"
        bonds = \"brittle\"
        particles = [{particles}]
        bond_list = [{bonds}]
        angular_velocity = [0, 0, 2500]
        [bodies.pair]
        material = \"cake\"
        bonds = \"brittle\"
        particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 2e-3]]
        bond_list = [[0, 1]]
        position = [0, 0, 1]
        velocity = [3, 0, 1]
        [output]
        series = 2e-6
        frames = 1e-4
        checkpoint = 1e-3
        "
    );
    scene_from_text(&text, "bursting.toml", &[]).unwrap()
}

/// A plan whose clusters are known.
pub(crate) fn planned(scene: &Scene) -> Plan {
    let mut plan = plan(scene, read_bodies(scene).unwrap(), 1, false).unwrap();
    let state = &mut plan.state;
    state.clusters = Some(Clusters::new(state.particles.len(), &state.bonds));
    plan
}

/// Runs a plan into a folder; it is interrupted at `stop_at` of its end time.
pub(crate) fn run_into(
    folder: &ResultsFolder,
    plan: Plan,
    scene: &Scene,
    resume: Option<Snapshot<'static>>,
    stop_at: f64,
) -> Result<Summary> {
    let interrupted = AtomicBool::new(false);
    let settings = RunSettings {
        folder: Some(folder),
        resume,
        test: None,
        setup: None,
        threads: 1,
        interrupted: &interrupted,
    };
    run(plan, scene, settings, &|so_far| {
        if so_far.fraction >= stop_at {
            interrupted.store(true, Ordering::Relaxed);
        }
    })
}

/// The bursting rod in a folder `out` that is removed after the test.
pub(crate) fn burst() -> (TempDir, ResultsFolder, Summary) {
    let parent = tempfile::tempdir().unwrap();
    let folder = ResultsFolder::create(&parent.path().join("out"), Existing::Refuse).unwrap();
    let scene = bursting();
    let summary = run_into(&folder, planned(&scene), &scene, None, 2.0).unwrap();
    (parent, folder, summary)
}

/// The header of a table, and its rows as texts, checked to have the same length.
pub(crate) fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(path).unwrap();
    let words = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<String>>();
    let mut lines = text.lines();
    let header = words(lines.next().unwrap());
    let rows: Vec<Vec<String>> = lines.map(words).collect();
    assert!(rows.iter().all(|row| row.len() == header.len()));
    (header, rows)
}
