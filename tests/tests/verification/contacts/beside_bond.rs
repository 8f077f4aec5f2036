//! A contact beside a bond.

use std::f64::consts::PI;

use dem_run::step;
use dem_run::step::interact;

use super::ball::POISSON;
use crate::verification::scene::started;
use crate::verification::table::{Case, compared};

/// Two bonded spheres that overlap are pressed and pulled by supports, at 1 mm/s, with the contact
/// beside their bond: in compression beyond the overlap at which they were bonded Hertz's force is
/// added to that of the bond, to the movement in a step.
pub(crate) fn beside_bond() -> String {
    const LENGTH_M: f64 = 1.9e-3;
    const STEP_S: f64 = 1e-6;
    let bond_n_m = 1e5 * PI * 1e-6 / LENGTH_M;
    let hertz = 4.0 / 3.0 * 1e6 / (2.0 * (1.0 - POISSON * POISSON)) * 0.5e-3_f64.sqrt();
    let cases = [10.0, 50.0, -50.0].map(|inwards_um| {
        let speed_m_s = -1e-3 * f64::signum(inwards_um);
        let mut state = started(&format!(
            r#"
            version = 1
            run = {{ end_time = "1 s", time_step = {STEP_S:e} }}
            relaxation.min_overlap = 0
            materials.m = {{ density = 2500, young_modulus = "1 MPa", poisson_ratio = {POISSON} }}
            contacts.m-m = {{ restitution = 1, friction = 0 }}
            bonds.b = {{ young_modulus = "0.1 MPa", poisson_ratio = {POISSON}, contact_beside_bond = true }}
            bodies.pair = {{ particles = [[0, 0, 0, 1e-3], [{LENGTH_M:e}, 0, 0, 1e-3]], bond_list = [[0, 1]], material = "m", bonds = "b" }}
            groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
            supports.left = {{ group = "left", fixed = true }}
            supports.right = {{ group = "right", velocity.x = {speed_m_s:e} }}
            "#,
        ));
        let inwards_m: f64 = 1e-6 * inwards_um;
        while state.time_s < inwards_m.abs() / 1e-3 - 0.5 * STEP_S {
            step(&mut state);
        }
        interact(&mut state);
        let found_n = state.particles.wrenches[1].force_n[0];
        let wanted_n = bond_n_m * inwards_m + hertz * inwards_m.max(0.0).powf(1.5);
        let bound = 1.5 * 1e-3 * STEP_S / inwards_m.abs();
        let [found, wanted] = [found_n, wanted_n].map(|x| 1e3 * x);
        Case::new(format!("{inwards_um} um inwards: force, mN"), found, wanted, bound)
    });
    compared("contact beside a bond", "", &cases)
}
