//! A small sphere, without weight, that two large spheres press from both sides: friction holds it
//! or it slips out.

use dem_run::{State, step};

use super::RATIOS;
use crate::verification::scene::{place, started};
use crate::verification::table::{Case, compared};

const LARGE_M: f64 = 5e-3;
/// Overlap of each contact after the approach, over the radius of the small sphere.
const OVERLAP: f64 = 1e-5;
/// Steps of the approach, and until it has slipped out or stays.
const STEPS: [usize; 2] = [2_000, 8_000];
/// Halvings of the range of friction.
const HALVINGS: i32 = 12;

/// Whether friction of this coefficient holds the small sphere, whose contacts have their normals
/// at this angle to the motion of the large ones.
fn is_held(ratio: f64, angle_rad: f64, friction: f64) -> bool {
    let small_m = LARGE_M / ratio;
    let reach_m = LARGE_M + small_m;
    let [away_m, height_m] = [angle_rad.cos(), angle_rad.sin()].map(|part| part * reach_m);
    // The approach takes 100 periods of the small sphere between two springs k.
    let [mass_kg, stiffness_n_m] = [1e-6_f64, 1e4];
    let step_s = 2.0 * std::f64::consts::PI * (0.5 * mass_kg / stiffness_n_m).sqrt() / 20.0;
    let approach_s = STEPS[0] as f64 * step_s;
    let speed_m_s = OVERLAP * small_m / (angle_rad.cos() * approach_s);
    let support = |group: &str, speed_m_s: f64| {
        format!(
            "supports.{group} = {{ group = \"{group}\", velocity = {{ x = {speed_m_s:e}, y = 0, z = 0, rx = 0, ry = 0, rz = 0 }}, table = [[0, 1], [{approach_s:e}, 1], [{:e}, 0]] }}",
            approach_s + step_s
        )
    };
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = "10 s", time_step = {step_s:e}, initial_overlap = "keep" }}
        materials.stone = {{ young_modulus = "10 GPa" }}
        contacts.stone-stone = {{ law = "linear", normal_stiffness = {stiffness_n_m:e}, restitution = 0.2, friction = {friction:e} }}
        bodies.fine = {{ particles = [[0, 0, {height_m:e}, {small_m:e}]], material = "stone", mass = {mass_kg:e} }}
        bodies.left = {{ particles = [[{:e}, 0, 0, {LARGE_M:e}]], material = "stone", mass = 1 }}
        bodies.right = {{ particles = [[{away_m:e}, 0, 0, {LARGE_M:e}]], material = "stone", mass = 1 }}
        {}
        {}
        "#,
        -away_m,
        support("left", speed_m_s),
        support("right", -speed_m_s),
    ));
    let rises_m = |state: &State| place(state, 0).z - height_m;
    for _ in 0..STEPS.iter().sum() {
        step(&mut state);
    }
    // One that slips out has risen until it no longer overlaps; one that is held by a fraction.
    let overlap_m = OVERLAP * small_m;
    rises_m(&state) < 0.5 * overlap_m / angle_rad.sin()
}

/// The least friction that holds it, by bisection, beside the tangent of the angle.
pub(super) fn held() -> String {
    let mut cases = Vec::new();
    for ratio in RATIOS {
        for degrees in [10.0_f64, 30.0] {
            let angle_rad = degrees.to_radians();
            let wanted = angle_rad.tan();
            let [mut slips, mut held] = [0.5 * wanted, 1.5 * wanted];
            assert!(!is_held(ratio, angle_rad, slips) && is_held(ratio, angle_rad, held));
            for _ in 0..HALVINGS {
                let middle = 0.5 * (slips + held);
                if is_held(ratio, angle_rad, middle) {
                    held = middle;
                } else {
                    slips = middle;
                }
            }
            // The last range, and the turn of the contacts by the overlap.
            let bound = 0.5_f64.powi(HALVINGS) + OVERLAP;
            cases.push(Case::new(
                format!("{ratio}, {degrees}°"),
                held,
                wanted,
                bound,
            ));
        }
    }
    compared("ratio of the radii, angle", "", &cases)
}
