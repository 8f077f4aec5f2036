//! `initial_overlap = "keep"`: bodies at rest stay at rest.

use std::f64::consts::PI;
use std::fmt::Write;

use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::step::{advance, interact, step};

use super::{assert_near, place, planned, try_planned};

const RADIUS_M: f64 = 5e-3;
const GRAVITY_M_S2: f64 = 9.81;
/// E* of a sphere of the glass below on a plane of the same, Pa.
const E_STAR_PA: f64 = 50e6 / (2.0 * (1.0 - 0.25 * 0.25));

fn mass_kg() -> f64 {
    2500.0 * 4.0 / 3.0 * PI * RADIUS_M.powi(3)
}

/// Overlap, m, for this Hertz force at this reduced radius.
fn overlap_m(force_n: f64, radius_m: f64) -> f64 {
    (0.75 * force_n / (E_STAR_PA * radius_m.sqrt())).powf(2.0 / 3.0)
}

fn scene(start: &str, particles: &[[f64; 3]]) -> String {
    let mut bodies = String::new();
    for (n, [x, y, z]) in particles.iter().enumerate() {
        let _ = writeln!(
            bodies,
            "bodies.ball{n} = {{ particles = [[{x:?}, {y:?}, {z:?}, {RADIUS_M}]], material = \"glass\" }}"
        );
    }
    format!(
        "version = 1\nrun = {{ end_time = 1, gravity = [0, 0, -{GRAVITY_M_S2}], initial_overlap = \"{start}\" }}\n\
         materials.glass = {{ density = 2500, young_modulus = \"50 MPa\", poisson_ratio = 0.25 }}\n\
         contacts.glass-glass = {{ restitution = 0.9 }}\n{bodies}\
         walls.ground = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"glass\" }}\n"
    )
}

/// A sphere on a plane, and one on top of another, at the overlaps for which Hertz forces carry
/// them.
#[test]
fn spheres_at_their_static_overlap_stay() {
    let weight_n = mass_kg() * GRAVITY_M_S2;
    let one = RADIUS_M - overlap_m(weight_n, RADIUS_M);
    let lower = RADIUS_M - overlap_m(2.0 * weight_n, RADIUS_M);
    let upper = lower + 2.0 * RADIUS_M - overlap_m(weight_n, 0.5 * RADIUS_M);
    for heights in [vec![one], vec![lower, upper]] {
        let places: Vec<[f64; 3]> = heights.iter().map(|&z| [0.0, 0.0, z]).collect();
        let mut state = planned(&scene("keep", &places)).state;
        let count = heights.len() as f64;
        for _ in 0..3000 {
            interact(&mut state);
            let now = balance(&mut state);
            assert!(now.energy_error.abs() < 1e-9, "{:e}", now.energy_error);
            assert!(
                now.kinetic_j < 1e-18 * now.contact_elastic_j,
                "{:e}",
                now.kinetic_j
            );
            let push_n = state.walls[0].push.force_n[2];
            assert_near(push_n, count * weight_n, 1e-9);
            advance(&mut state);
        }
        for (i, z) in heights.iter().enumerate() {
            let moved_m = (place(&state, i).z - z).abs();
            assert!(
                moved_m < 1e-9 * overlap_m(weight_n, RADIUS_M),
                "{i}: {moved_m:e} m"
            );
        }
    }
}

/// The ledger opens with the stored energy: 2/5 F d of every Hertz contact, with plane and sphere.
#[test]
fn the_energy_of_what_is_kept_is_counted_from_the_start() {
    let weight_n = mass_kg() * GRAVITY_M_S2;
    let on_plane = overlap_m(2.0 * weight_n, RADIUS_M);
    let on_sphere = overlap_m(weight_n, 0.5 * RADIUS_M);
    let lower = RADIUS_M - on_plane;
    let upper = lower + 2.0 * RADIUS_M - on_sphere;
    let text = scene("keep", &[[0.0, 0.0, lower], [0.0, 0.0, upper]]);
    let mut state = planned(&text).state;
    interact(&mut state);
    let now = balance(&mut state);
    let stored_j = 0.4 * (2.0 * weight_n * on_plane + weight_n * on_sphere);
    assert_near(now.contact_elastic_j, stored_j, 1e-9);
    assert!(now.energy_error.abs() < 1e-12, "{:e}", now.energy_error);
}

/// Pressed deeper than equilibrium, they fly apart with the stored energy.
#[test]
fn what_is_kept_pushes_with_its_full_force() {
    let depth_m = 1e-4;
    let text = scene("keep", &[[0.0, 0.0, RADIUS_M - depth_m]]);
    let text = text
        .replace("restitution = 0.9", "restitution = 1")
        .replace("-9.81", "0");
    let mut state = planned(&text).state;
    while place(&state, 0).z < RADIUS_M {
        step(&mut state);
    }
    let stored_j = 8.0 / 15.0 * E_STAR_PA * RADIUS_M.sqrt() * depth_m.powf(2.5);
    let speed_m_s = (2.0 * stored_j / mass_kg()).sqrt();
    assert_near(state.particles.motions[0].velocity_m_s[2], speed_m_s, 5e-3);
    // With "relax" the overlap is the origin of their contact law.
    let mut relaxed = planned(&text.replace("keep", "relax")).state;
    for _ in 0..1000 {
        step(&mut relaxed);
    }
    assert_eq!(place(&relaxed, 0).z, RADIUS_M - depth_m);
}

/// A heap at rest is restarted from the positions of its spheres and stays at rest.
#[test]
fn a_bed_taken_up_from_its_places_goes_on_resting() {
    let mut places = Vec::new();
    for z in 0..2 {
        for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let [x, y] = [x, y].map(|n| f64::from(n) * 2.0 * RADIUS_M + f64::from(z) * RADIUS_M);
            let z = (1.0 + f64::from(z) * 2f64.sqrt()) * RADIUS_M;
            places.push([x, y, z]);
        }
    }
    let sides = format!(
        "walls.left = {{ plane = {{ point = [-{RADIUS_M}, -{RADIUS_M}, 0], normal = [1, 0, 0] }}, material = \"glass\" }}\n\
         walls.front = {{ plane = {{ point = [-{RADIUS_M}, -{RADIUS_M}, 0], normal = [0, 1, 0] }}, material = \"glass\" }}\n\
         walls.right = {{ plane = {{ point = [{0}, {0}, 0], normal = [-1, 0, 0] }}, material = \"glass\" }}\n\
         walls.back = {{ plane = {{ point = [{0}, {0}, 0], normal = [0, -1, 0] }}, material = \"glass\" }}\n",
        4.0 * RADIUS_M
    );
    let settling = scene("relax", &places).replace("restitution = 0.9", "restitution = 0.1");
    let mut state = planned(&format!("{settling}{sides}")).state;
    while state.time_s < 1.0 {
        step(&mut state);
    }
    let deepest_m = overlap_m(8.0 * mass_kg() * GRAVITY_M_S2, RADIUS_M);
    let settled: Vec<[f64; 3]> = (0..8).map(|i| place(&state, i).into()).collect();
    let text = format!("{}{sides}", scene("keep", &settled));
    let mut again = planned(&text).state;
    let moved = |of: &dem_engine::state::State| {
        let all = (0..8).map(|i| (place(of, i) - nalgebra::Vector3::from(settled[i])).norm());
        all.fold(0.0, f64::max)
    };
    for _ in 0..2000 {
        step(&mut again);
        let moved_m = moved(&again);
        assert!(
            moved_m < 1e-6 * deepest_m,
            "{moved_m:e} m of {deepest_m:e} m"
        );
    }
    // Restarted without it: refused. With "relax" it sinks as before.
    assert!(try_planned(&text.replace("keep", "refuse")).is_err());
    let mut sinking = planned(&text.replace("keep", "relax")).state;
    for _ in 0..2000 {
        step(&mut sinking);
    }
    assert!(moved(&sinking) > 0.1 * deepest_m);
}
