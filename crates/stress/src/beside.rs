//! Contacts beside bonds, far softer and far harder than these.

use std::f64::consts::PI;

use super::prediction::{Member, Quantity, Shown};
use super::trial::Trial;

const RADIUS_M: f64 = 1e-3;
/// The spheres overlap by a tenth of a radius.
const LENGTH_M: f64 = 1.9e-3;
const DENSITY_KG_M3: f64 = 2500.0;
const YOUNG_PA: f64 = 1e7;
const SPEED_M_S: f64 = 0.01;
/// Permitted relative error.
const PERMITTED: f64 = 1e-2;

/// Two spheres run towards each other, turn where bond and contact have taken up their energy, and
/// turn again where the bond alone has. The contact is up to a million times softer or harder than
/// the bond.
pub(super) fn beside() -> Vec<Member> {
    [1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6].map(member).into()
}

fn member(ratio: f64) -> Member {
    let mass_kg = DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    let bond_n_m = YOUNG_PA * PI * RADIUS_M * RADIUS_M / LENGTH_M;
    let contact_n_m = ratio * bond_n_m;
    // Each sphere on a spring twice as stiff.
    let [pressed_1_s, pulled_1_s] =
        [bond_n_m + contact_n_m, bond_n_m].map(|n_m| (2.0 * n_m / mass_kg).sqrt());
    let end_s = (1.1 * PI) * (1.0 / pressed_1_s + 1.0 / pulled_1_s);
    let text = format!(
        "version = 1
run = {{ end_time = {end_s:e}, safety_factor = 0.02 }}
relaxation.min_overlap = 0
materials.m = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3 }}
contacts.m-m = {{ law = \"linear\", normal_stiffness = {contact_n_m:e}, restitution = 1, friction = 0 }}
bonds.b = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3, contact_beside_bond = true }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{LENGTH_M:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = \"m\", bonds = \"b\" }}
groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
initial.left = {{ group = \"left\", velocity = [{SPEED_M_S:e}, 0, 0] }}
initial.right = {{ group = \"right\", velocity = [{:e}, 0, 0] }}
measures.in = {{ of = \"right\", quantity = \"displacement_x\", statistic = \"smallest\" }}
measures.out = {{ of = \"right\", quantity = \"displacement_x\", statistic = \"largest\" }}
output.series = {:e}
",
        -SPEED_M_S,
        1e-5 * end_s
    );
    let [pressed_m, pulled_m] = [pressed_1_s, pulled_1_s].map(|rate| SPEED_M_S / rate);
    Member::ends(
        format!("contact {ratio:e} times as stiff as the bond"),
        Trial::of(text),
        vec![
            Shown::measure("in", "m", -pressed_m, PERMITTED * pressed_m),
            Shown::measure("out", "m", pulled_m, PERMITTED * pulled_m),
            Shown::at_most(Quantity::EnergyError, 1e-3),
        ],
    )
}
