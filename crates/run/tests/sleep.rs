//! Sleep: bodies at rest on ground at rest are not integrated, without any other change.

mod again;
mod books;
mod lists;
mod restless;
mod riding;
mod settle;
mod wake;

use std::fmt::Write;

use dem_engine::state::State;
use dem_engine::state::sleep::Sleep;
use dem_engine::step::step;
use nalgebra::Vector3;

use crate::helpers::{planned, started};

pub(crate) const GRAVITY_M_S2: f64 = 9.81;
/// Speed limit for sleep in these scenes.
pub(crate) const SPEED_M_S: f64 = 1e-3;
pub(crate) const AFTER_S: f64 = 5e-3;
/// Radius of all spheres.
pub(crate) const RADIUS_M: f64 = 1e-3;

pub(crate) const SLEEP: &str = "[sleep]\nspeed = \"1 mm/s\"\nafter = \"5 ms\"\n";
pub(crate) const GROUND: &str =
    "[walls.ground]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"stuff\"\n";

/// The head of a scene with ground inclined by this angle, rad, by a rotation of gravity.
pub(crate) fn head(slope_rad: f64) -> String {
    let (sine, cosine) = slope_rad.sin_cos();
    format!(
        "version = 1\nrun.end_time = 1\nrun.gravity = [{}, 0, {}]\n\
         materials.stuff = {{ density = 2500, young_modulus = 1e8, poisson_ratio = 0.25 }}\n\
         bonds.stiff = {{ young_modulus = 1e8, poisson_ratio = 0.25, damping = {{ damping_ratio = 0.3 }} }}\n\
         contacts.stuff-stuff = {{ restitution = 0.05, friction = 0.8 }}\n",
        GRAVITY_M_S2 * sine,
        -GRAVITY_M_S2 * cosine
    )
}

/// A slab of two by two spheres with its lowest points at this position, m.
pub(crate) fn slab(name: &str, [x_m, y_m, z_m]: [f64; 3], more: &str) -> String {
    let mut particles = String::new();
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let [x, y] = [x, y].map(|n| 2.0 * RADIUS_M * f64::from(n));
        write!(particles, "[{x:e}, {y:e}, {RADIUS_M:e}, {RADIUS_M:e}],").unwrap();
    }
    format!(
        "[bodies.{name}]\nmaterial = \"stuff\"\nbonds = \"stiff\"\nparticles = [{particles}]\n\
         bond_list = [[0, 1], [0, 2], [1, 3], [2, 3]]\nposition = [{x_m:e}, {y_m:e}, {z_m:e}]\n{more}\n"
    )
}

pub(crate) const CLUMP: &str = "start_as = \"clump\"";

/// A sphere with its lowest point at this position, m.
pub(crate) fn ball(name: &str, [x_m, y_m, z_m]: [f64; 3], more: &str) -> String {
    format!(
        "[bodies.{name}]\nmaterial = \"stuff\"\n\
         particles = [[{x_m:e}, {y_m:e}, {:e}, {RADIUS_M:e}]]\n{more}\n",
        z_m + RADIUS_M
    )
}

/// A step as in a run.
pub(crate) fn go(state: &mut State) {
    step(state);
}

pub(crate) fn go_until(state: &mut State, time_s: f64) {
    while state.time_s < time_s {
        go(state);
    }
}

pub(crate) fn sleep(state: &State) -> &Sleep {
    state.sleep.as_ref().unwrap()
}

/// Continues until this number of bodies sleep.
pub(crate) fn go_until_asleep(state: &mut State, bodies: usize) {
    while sleep(state).bodies < bodies {
        assert!(state.time_s < 0.5, "{} asleep", sleep(state).bodies);
        go(state);
    }
}

/// Largest distance between the particles of two states, m.
pub(crate) fn apart_m(a: &State, b: &State) -> f64 {
    let pairs = a.particles.poses.iter().zip(&b.particles.poses);
    pairs.fold(0.0, |largest, (a, b)| {
        (a.place() - b.place()).norm().max(largest)
    })
}

/// Depth, m, of one of the four spheres of a body of this mass, kg, at rest.
pub(crate) fn depth_m(mass_kg: f64) -> f64 {
    let reduced_pa = 1e8 / (2.0 * (1.0 - 0.25 * 0.25));
    let force_n = 0.25 * mass_kg * GRAVITY_M_S2;
    (0.75 * force_n / (reduced_pa * RADIUS_M.sqrt())).powf(2.0 / 3.0)
}

/// Mass of four spheres, kg.
pub(crate) fn slab_kg() -> f64 {
    4.0 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS_M.powi(3)
}

/// Numbers of contacts, bonds and wall contacts that a step processes.
pub(crate) fn work(state: &State) -> [usize; 4] {
    let bonds = state
        .scratch
        .partitions
        .iter()
        .map(dem_engine::state::partitions::Partition::own_bonds)
        .sum();
    [
        bonds,
        state.contacts.as_ref().unwrap().pairs.len(),
        state.walls.iter().map(|wall| wall.near.len()).sum(),
        state.walls.iter().map(|wall| wall.touching.len()).sum(),
    ]
}

/// Force of contacts, walls and bonds on a clump, N.
pub(crate) fn force_on_clump(state: &State, n: usize) -> Vector3<f64> {
    state.clumps.all[n].force_n.into()
}
