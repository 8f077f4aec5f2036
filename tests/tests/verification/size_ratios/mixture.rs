//! Small spheres fall through a layer of large ones that touch: none stays in a neck, since two
//! contacts below a sphere hold it only at the highest point.

use std::f64::consts::PI;

use dem_run::{State, step};

use crate::verification::scene::{place, started};
use crate::verification::table::{Case, compared};

const LARGE_M: f64 = 5e-3;
/// Small spheres along each side of their square.
const ACROSS: u32 = 8;
const END_S: f64 = 0.8;

/// Seven large spheres, one in the middle of the others.
fn large() -> String {
    let around = (0..6).map(|n| {
        let (sine, cosine) = (f64::from(n) * PI / 3.0).sin_cos();
        format!(
            ", [{:e}, {:e}, 0, {LARGE_M:e}]",
            2.0 * LARGE_M * cosine,
            2.0 * LARGE_M * sine
        )
    });
    format!("[0, 0, 0, {LARGE_M:e}]{}", around.collect::<String>())
}

/// Above the middle one, each a little beside its place in a square, so high that they come one
/// after another.
fn small(radius_m: f64) -> String {
    let places = (0..ACROSS * ACROSS).map(|n| {
        let [i, j] = [n % ACROSS, n / ACROSS].map(f64::from);
        let beside = |k: f64| 0.2 * (k * 12.9898).sin();
        let along = |i: f64, k: f64| LARGE_M * 0.22 * (i - 3.5 + beside(k));
        let [x, y] = [along(i, f64::from(n)), along(j, f64::from(n) + 0.5)];
        let z = 2.0 * LARGE_M + 2.5 * radius_m * f64::from(n);
        format!("[{x:e}, {y:e}, {z:e}, {radius_m:e}]")
    });
    places.collect::<Vec<_>>().join(", ")
}

/// Those that are not below the layer at the end, of this ratio of radii.
fn left(ratio: f64) -> usize {
    let radius_m = LARGE_M / ratio;
    let mass_kg = 2500.0 * 4.0 / 3.0 * PI * radius_m.powi(3);
    let step_s = 1e-5;
    // The impact of two of them takes 40 steps.
    let stiffness_n_m = 0.5 * mass_kg * (PI / (40.0 * step_s)).powi(2);
    let mut state: State = started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = {step_s:e}, gravity = [0, 0, -9.81] }}
        materials.stone = {{ density = 2500, young_modulus = "10 GPa" }}
        contacts.stone-stone = {{ law = "linear", normal_stiffness = {stiffness_n_m:e}, restitution = 0.5, friction = 0.5 }}
        bodies.fine = {{ particles = [{}], material = "stone" }}
        bodies.large = {{ particles = [{}], material = "stone" }}
        supports.large = {{ group = "large", fixed = true }}
        "#,
        small(radius_m),
        large(),
    ));
    while state.time_s < END_S {
        step(&mut state);
    }
    let all = 0..(ACROSS * ACROSS) as usize;
    all.filter(|&n| place(&state, n).z > -LARGE_M).count()
}

/// The number of small spheres that are left on the layer.
pub(super) fn settles() -> String {
    let cases = [10.0, 20.0, 50.0].map(|ratio| {
        let what = format!("{ratio}: left of {}", ACROSS * ACROSS);
        Case::of_scale(what, [left(ratio) as f64, 0.0], 1.0, 0.0)
    });
    compared("ratio of the radii", "", &cases)
}
