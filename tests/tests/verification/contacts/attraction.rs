//! Spheres that stick to a plate, to each other, or by a liquid bridge.

use std::f64::consts::PI;

use dem_run::step::{advance, interact};
use dem_run::{State, step};

use super::ball::{DENSITY_KG_M3, POISSON};
use crate::verification::scene::{place, started};
use crate::verification::table::{Case, compared};

/// A fine sphere that sticks to a plate, without gravity. `overlap_m`: at the start; `more`: what
/// else the scene has; `motion`: of the plate.
fn sticking(work_j_m2: f64, overlap_m: f64, [motion, more]: [&str; 2]) -> State {
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = "0.1 us", initial_overlap = "keep" }}
        materials.powder = {{ density = {DENSITY_KG_M3:e}, young_modulus = {FINE_PA:e}, poisson_ratio = {POISSON} }}
        contacts.powder-powder = {{ law = "dmt", work_of_adhesion = {work_j_m2:e}, restitution = 0.1 }}
        bodies.ball = {{ particles = [[0, 0, {:e}, {FINE_M:e}]], material = "powder" }}
        walls.plate = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = "powder"{motion} }}
        {more}
        "#,
        FINE_M - overlap_m,
    ))
}

/// Radius, m, and Young's modulus, Pa, of a sphere that sticks.
const FINE_M: f64 = 1e-4;
const FINE_PA: f64 = 1e8;

/// The sphere comes to rest at the overlap at which Hertz's force is the attraction. Held there, it
/// is pulled with at most 2 pi w R by a plate that retreats.
pub(crate) fn adhesion() -> String {
    let hertz = 4.0 / 3.0 * FINE_PA / (2.0 * (1.0 - POISSON * POISSON)) * FINE_M.sqrt();
    let overlap_m = |state: &State| FINE_M - place(state, 0).z;
    let mut cases = Vec::new();
    for work_j_m2 in [5e-3, 0.05] {
        let force_n = 2.0 * PI * work_j_m2 * FINE_M;
        let wanted_m = (force_n / hertz).powf(2.0 / 3.0);
        let mut state = sticking(work_j_m2, 1e-9, ["", ""]);
        while state.time_s < 2e-3 {
            step(&mut state);
        }
        let name = format!("{} mJ/m2", 1e3 * work_j_m2);
        let rest = [overlap_m(&state), wanted_m].map(|x| 1e6 * x);
        let what = format!("{name}: overlap at rest, um");
        cases.push(Case::new(what, rest[0], rest[1], 1e-6));

        let motion = ", velocity = [0, 0, -1e-3]";
        let held = "supports.ball = { group = \"ball\", velocity.z = 0 }";
        let mut state = sticking(work_j_m2, wanted_m, [motion, held]);
        let mut largest_n = 0.0_f64;
        while state.time_s < 2.0 * wanted_m / 1e-3 {
            interact(&mut state);
            largest_n = largest_n.max(-state.walls[0].total_load()[0][2]);
            advance(&mut state);
        }
        // Hertz's force one step before the separation.
        let bound = hertz * 1e-10_f64.powf(1.5) / force_n;
        let pull = [largest_n, force_n].map(|x| 1e6 * x);
        let what = format!("{name}: pull-off force, uN");
        cases.push(Case::new(what, pull[0], pull[1], bound));
        for times in [1.0, 3.0] {
            let [found_n, wanted_n, bound] = parted(work_j_m2, times * FINE_M);
            let what = format!(
                "{name}: pull-off force from a sphere of {:.1} mm, uN",
                0.1 * times
            );
            cases.push(Case::new(what, 1e6 * found_n, 1e6 * wanted_n, bound));
        }
    }
    compared("work of adhesion", "", &cases)
}

/// Two spheres, one of them of this radius, m, are pulled apart from their overlap at rest at
/// 1 mm/s: the largest force, N, and that of the closed form with its bound.
fn parted(work_j_m2: f64, radius_m: f64) -> [f64; 3] {
    let effective_m = FINE_M * radius_m / (FINE_M + radius_m);
    let hertz = 4.0 / 3.0 * FINE_PA / (2.0 * (1.0 - POISSON * POISSON)) * effective_m.sqrt();
    let force_n = 2.0 * PI * work_j_m2 * effective_m;
    let rest_m = (force_n / hertz).powf(2.0 / 3.0);
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = "1 s", time_step = 1e-7, initial_overlap = "keep" }}
        materials.powder = {{ density = 2500, young_modulus = {FINE_PA:e}, poisson_ratio = {POISSON} }}
        contacts.powder-powder = {{ law = "dmt", work_of_adhesion = {work_j_m2:e}, restitution = 0.1 }}
        bodies.ball = {{ particles = [[0, 0, 0, {FINE_M:e}]], material = "powder" }}
        bodies.other = {{ particles = [[{:e}, 0, 0, {radius_m:e}]], material = "powder" }}
        supports.ball = {{ group = "ball", fixed = true }}
        supports.other = {{ group = "other", fixed = ["y", "z", "rx", "ry", "rz"], velocity.x = 1e-3 }}
        "#,
        FINE_M + radius_m - rest_m
    ));
    let mut largest_n = 0.0_f64;
    while state.time_s < 2.0 * rest_m / 1e-3 {
        interact(&mut state);
        largest_n = largest_n.max(-state.particles.wrenches[1].force_n[0]);
        advance(&mut state);
    }
    // Hertz's force one step before the separation.
    [largest_n, force_n, hertz * 1e-10_f64.powf(1.5) / force_n]
}

/// A sphere of 1 mm is pulled from another, or from a wall, at 1 mm/s: the pull-off force, the gap
/// at rupture and the energy lost are those of the closed forms, to the movement in a step.
pub(crate) fn liquid_bridge() -> String {
    const RADIUS_M: f64 = 1e-3;
    const STEP_S: f64 = 5e-6;
    const SPEED_M_S: f64 = 1e-3;
    let mut cases = Vec::new();
    for degrees in [0.0_f64, 30.0] {
        let angle = degrees.to_radians();
        let rupture_m = (1.0 + 0.5 * angle) * 1e-4;
        // R of Derjaguin: that of two equal spheres; of a sphere and a wall twice that.
        for (what, derjaguin_m) in [("sphere", RADIUS_M), ("wall", 2.0 * RADIUS_M)] {
            let other = if what == "wall" {
                "walls.plate = { plane = { point = [0, 0, 0], normal = [0, 0, 1] }, material = \"glass\", velocity = [0, 0, -1e-3] }"
            } else {
                "bodies.other = { particles = [[0, 0, -1e-3, 1e-3]], material = \"glass\", velocity = [0, 0, -1e-3] }
                 supports.other = { group = \"other\", fixed = [\"x\", \"y\"], velocity.z = -1e-3 }"
            };
            let mut state = started(&format!(
                r#"
                version = 1
                run = {{ end_time = "1 s", time_step = {STEP_S:e}, initial_overlap = "keep" }}
                materials.glass = {{ density = 2500, young_modulus = "100 MPa" }}
                contacts.glass-glass = {{ restitution = 1, liquid_bridge = {{ surface_tension = "73 mN/m", contact_angle = "{degrees} deg", volume = "1e-3 mm3" }} }}
                bodies.ball = {{ particles = [[0, 0, {:e}, 1e-3]], material = "glass" }}
                supports.ball = {{ group = "ball", fixed = ["x", "y", "z"] }}
                {other}
                "#,
                RADIUS_M - 1e-9
            ));
            let (mut largest_n, mut gap_m) = (0.0_f64, 0.0_f64);
            while state.time_s < 1.1 * rupture_m / SPEED_M_S {
                interact(&mut state);
                let down_n = -state.particles.wrenches[0].force_n[2];
                largest_n = largest_n.max(down_n);
                if down_n > 0.0 {
                    gap_m = SPEED_M_S * state.time_s;
                }
                advance(&mut state);
            }
            let pull_n = 2.0 * PI * derjaguin_m * 0.073 * angle.cos();
            let scale_m = (1e-12 / derjaguin_m).sqrt();
            let x = rupture_m / scale_m;
            let root = 8.8975_f64.sqrt();
            let work_j = pull_n * scale_m * 2.0 / root * (root * x / (2.0 + 1.05 * x)).atan();
            let step_m = SPEED_M_S * STEP_S;
            let last_n = pull_n / (1.0 + 1.05 * x + 2.5 * x * x);
            let lost_j = state.bridges.as_ref().map_or(0.0, |bridges| bridges.lost_j);
            let name = format!("{what}, {degrees}°");
            let [found, wanted] = [largest_n, pull_n].map(|x| 1e6 * x);
            cases.push(Case::new(
                format!("{name}: pull-off force, uN"),
                found,
                wanted,
                1.05 * step_m / scale_m,
            ));
            let [found, wanted] = [gap_m, rupture_m].map(|x| 1e6 * x);
            cases.push(Case::new(
                format!("{name}: gap at rupture, um"),
                found,
                wanted,
                1.01 * step_m / rupture_m,
            ));
            let [found, wanted] = [lost_j, work_j].map(|x| 1e9 * x);
            let bound = (last_n * step_m + pull_n * 1e-9) / work_j;
            cases.push(Case::new(
                format!("{name}: energy lost, nJ"),
                found,
                wanted,
                bound,
            ));
        }
    }
    compared("liquid bridge", "", &cases)
}
