//! Friction that is left where a bond has broken under pressure.

use dem_run::stages::ledger::bookkeeping::balance;
use dem_run::step;
use dem_run::step::{advance, interact};

use super::bond::{COHESION_PA, Criterion, DAMPING, FRICTION_DEG, POISSON, RADIUS_M, area_m2};
use crate::verification::scene::started;
use crate::verification::table::{Case, compared};

/// Way of a sphere that slides past another, m.
const WAY_M: f64 = 3e-6;

/// Two touching spheres that a load presses together while one slides past the other: the shear
/// force at which their Mohr-Coulomb bond breaks, and that afterwards, N.
fn sheared_under(pressure_pa: f64, friction: f64) -> [f64; 2] {
    const YOUNG_PA: f64 = 1e10;
    let press_n = pressure_pa * area_m2();
    let mut state = started(&format!(
        r#"
        version = 1
        run = {{ end_time = 0.07, safety_factor = 0.5 }}
        materials.stone = {{ density = 2500, young_modulus = 1e10, poisson_ratio = {POISSON:e} }}
        contacts.stone-stone = {{ restitution = 0.1, friction = {friction} }}
        bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = "stone", bonds = "glue" }}
        groups.left = {{ particles = [0] }}
        groups.right = {{ particles = [1] }}
        bonds.glue = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON:e}, damping = {{ damping_ratio = {DAMPING} }}, failure = {{ {} }} }}
        supports.left = {{ group = "left", fixed = true }}
        supports.right = {{ group = "right", fixed = ["z", "rx", "ry", "rz"], displacement = {{ y = {WAY_M:e} }}, table = [[0.01, 0], [0.04, 1], [0.07, 2]] }}
        loads.press = {{ group = "right", force = [{:e}, 0, 0], ramp = 0.005 }}
        "#,
        2.0 * RADIUS_M,
        Criterion::MohrCoulomb.key(),
        -press_n
    ));
    let (mut broke_n, mut work_j, mut way_m, mut last_n) = (f64::NAN, 0.0, 0.0, 0.0);
    for row in 1..=2000 {
        let until_s = 0.01 + 0.03 * f64::from(row) / 2000.0;
        while state.time_s < until_s {
            step(&mut state);
        }
        interact(&mut state);
        let now = balance(&mut state);
        let moved_m = WAY_M * ((state.time_s - 0.01) / 0.03).max(0.0);
        let shear_n = (now.support_work_j - work_j) / (moved_m - way_m);
        if state.broken_count > 0 && broke_n.is_nan() {
            broke_n = last_n;
        }
        (work_j, way_m, last_n) = (now.support_work_j, moved_m, shear_n);
        advance(&mut state);
    }
    [broke_n, last_n]
}

/// Friction after a break under pressure is that of the contact.
pub(crate) fn residual() -> String {
    let mut cases = Vec::new();
    for (pressure_pa, friction) in [(0.2e6, 0.3), (0.2e6, 0.6), (1.0e6, 0.3)] {
        let press_n = pressure_pa * area_m2();
        let strength_pa = COHESION_PA + pressure_pa * FRICTION_DEG.to_radians().tan();
        let [broke_n, left_n] = sheared_under(pressure_pa, friction);
        let what = format!("{:.1} MPa, friction {friction}", 1e-6 * pressure_pa);
        // The load is known from row to row.
        cases.push(Case::new(
            format!("{what}: breaks at, N"),
            broke_n,
            strength_pa * area_m2(),
            0.01,
        ));
        // The way across tilts the contact, by this at the end.
        let tilt = WAY_M / (2.0 * RADIUS_M);
        cases.push(Case::new(
            format!("{what}: slides at, N"),
            left_n,
            press_n * (friction - tilt) / (1.0 + friction * tilt),
            1e-3,
        ));
    }
    compared("pressure", "", &cases)
}
