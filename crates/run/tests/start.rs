//! Start and end conditions of a scene: displaced and moving groups, supports and loads that end,
//! overlaps that are kept, a bounce; rigid walls and clumps that are never replaced.

mod bounce;
mod drops;
mod ends;
mod initial;
mod keep;
mod rigid;

use std::sync::atomic::{AtomicBool, Ordering};

use dem_engine::state::State;
use dem_io::Result;
use dem_results::ResultsFolder;
use dem_results::Summary;
use dem_runner::snapshot::Snapshot;
use dem_runner::{RunSettings, run};
use nalgebra::Vector3;

use crate::helpers::{planned, scene, try_planned};

/// Two spheres of 1 mm and 1000 kg/m3, bonded along x and 2 mm apart. The bond has the stiffness E
/// A/L with a radius of 1 mm.
const PAIR: &str = "version = 1\nmaterials.m.density = 1000\n\
     bonds.b = { model = \"parallel\", young_modulus = \"1 MPa\", poisson_ratio = 0.3, radius_factor = 1 }\n\
     bodies.pair = { material = \"m\", bonds = \"b\", particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3]], bond_list = [[0, 1]] }\n\
     groups.first = { body = \"pair\", particles = [0] }\n\
     groups.second = { body = \"pair\", particles = [1] }\n";

/// Stiffness of the bond of [`PAIR`], N/m.
const STIFFNESS_N_M: f64 = 1e6 * std::f64::consts::PI * 1e-6 / 2e-3;
/// Mass of one of its spheres, kg.
const MASS_KG: f64 = 1000.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-9;

/// Runs a scene, with or without a folder; it is interrupted at `stop_at` of its end time.
fn run_of(
    text: &str,
    folder: Option<&ResultsFolder>,
    resume: Option<Snapshot<'static>>,
    stop_at: f64,
) -> Result<Summary> {
    let interrupted = AtomicBool::new(false);
    let settings = RunSettings {
        folder,
        resume,
        test: None,
        setup: None,
        threads: 1,
        interrupted: &interrupted,
    };
    run(planned(text), &scene(text), settings, &|so_far| {
        if so_far.fraction >= stop_at {
            interrupted.store(true, Ordering::Relaxed);
        }
    })
}

/// Centre of a particle, m.
fn place(state: &State, particle: usize) -> Vector3<f64> {
    state.particles.poses[particle].place()
}

fn assert_near(got: f64, wanted: f64, tolerance: f64) {
    let off = (got / wanted - 1.0).abs();
    assert!(
        off <= tolerance,
        "{got:e}, not {wanted:e}: off by {off:.1e}"
    );
}
