//! Bonds of the other models at rest under a load: spheres of different size, and pins.

use std::f64::consts::PI;

use dem_run::step;

use crate::verification::scene::{place, started};
use crate::verification::table::{Case, compared};

const RADIUS_M: f64 = 1e-3;
const YOUNG_PA: f64 = 1e9;
const POISSON: f64 = 0.25;
/// Load over E times the area of a sphere: so small that the second order is rounding.
const STRAIN: f64 = 1e-8;
/// What is left of the motion, and of the second order.
const BOUND: f64 = 1e-6;

/// Displacement of a particle from its start after 20 000 damped steps, m.
fn moved_m(particle: usize, scene: &str) -> [f64; 3] {
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 h", safety_factor = 0.5 }}
        materials.stone = {{ density = 2500, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e} }}
        {scene}
        "#
    ));
    let start = place(&state, particle);
    for _ in 0..20_000 {
        step(&mut state);
    }
    (place(&state, particle) - start).into()
}

const DAMPED: &str = "damping = { damping_ratio = 0.5, per_mode = true }";

/// Elongation of the bond of Rojek between touching spheres, whose segments are half as thick as
/// they: k_n = E pi f^2 R_a R_b/(R_a + R_b).
fn elongation(ratio: f64) -> Case {
    const FACTOR: f64 = 0.5;
    let radii_m = [RADIUS_M, ratio * RADIUS_M];
    let sum_m = radii_m[0] + radii_m[1];
    let load_n = STRAIN * YOUNG_PA * PI * RADIUS_M * RADIUS_M;
    let [x, ..] = moved_m(
        1,
        &format!(
            r#"
            bodies.pair = {{ particles = [[0, 0, 0, {:e}], [{sum_m:e}, 0, 0, {:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue" }}
            bonds.glue = {{ model = "rojek", young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, radius_factor = {FACTOR}, {DAMPED} }}
            groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
            supports.left = {{ group = "left", fixed = true }}
            loads.right = {{ group = "right", force = [{load_n:e}, 0, 0] }}
            "#,
            radii_m[0], radii_m[1],
        ),
    );
    let normal = YOUNG_PA * PI * FACTOR * FACTOR * radii_m[0] * radii_m[1] / sum_m;
    let what = format!("Rojek, radii 1 : {ratio}: elongation");
    Case::new(what, 1e12 * x, 1e12 * load_n / normal, BOUND).rounding(BOUND)
}

/// The top of a triangle of touching spheres, whose other two are held, under a load along x or y.
/// Pins turn freely, but slide with the stiffness k_s = k_n/(2 (1 + nu)): down, the top is held by
/// 2 (k_n sin^2 60 + k_s cos^2 60); across, it turns until no pin slides, and 2 k_n cos^2 60 is
/// left.
fn triangle(axis: usize) -> Case {
    let height_m = 3.0_f64.sqrt() * RADIUS_M;
    let load_n = STRAIN * YOUNG_PA * PI * RADIUS_M * RADIUS_M;
    let mut force_n = [0.0; 3];
    force_n[axis] = -load_n;
    let moved = moved_m(
        2,
        &format!(
            r#"
            bodies.truss = {{ particles = [[{:e}, 0, 0, {RADIUS_M:e}], [{RADIUS_M:e}, 0, 0, {RADIUS_M:e}], [0, {height_m:e}, 0, {RADIUS_M:e}]], bond_list = [[0, 1], [0, 2], [1, 2]], material = "stone", bonds = "glue" }}
            bonds.glue = {{ model = "pin", young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, {DAMPED} }}
            groups = {{ base = {{ particles = [0, 1] }}, top = {{ particles = [2] }} }}
            supports.base = {{ group = "base", fixed = true }}
            loads.top = {{ group = "top", force = {force_n:?} }}
            "#,
            -RADIUS_M,
        ),
    );
    let normal = YOUNG_PA * PI * RADIUS_M / 2.0;
    let shear = normal / (2.0 * (1.0 + POISSON));
    let (name, stiffness) = match axis {
        0 => ("across", 2.0 * normal * 0.25),
        _ => ("down", 2.0 * (normal * 0.75 + shear * 0.25)),
    };
    let what = format!("triangle of pins: {name}");
    Case::new(what, -1e12 * moved[axis], 1e12 * load_n / stiffness, BOUND).rounding(BOUND)
}

/// Displacements under a load.
pub(super) fn of_others() -> String {
    let mut cases: Vec<Case> = [1.0, 2.0, 4.0].map(elongation).to_vec();
    cases.extend([0, 1].map(triangle));
    compared("bond", "pm", &cases)
}
