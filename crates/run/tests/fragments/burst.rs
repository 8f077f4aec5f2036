//! A rod that bursts, and its run. The tests of the program take fragments from it too.

use std::fmt::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use dem_engine::state::clusters::Clusters;
use dem_io::Result;
use dem_plan::{Plan, plan};
use dem_results::{Existing, ResultsFolder, Summary};
use dem_runner::snapshot::Snapshot;
use dem_runner::{RunSettings, run};
use dem_scene::{Scene, read_bodies, scene_from_text};
use tempfile::TempDir;

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
