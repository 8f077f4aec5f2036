//! A row of bonded spheres between the ends of two bars, whose impedance is far from that of the
//! row.
//!
//! The bars' ends follow the force on them. A light bar moves as the row does, a heavy one as it
//! likes; neither may make the step of a row between fixed walls unstable, and the works of the
//! bars have to close the balance of energy.

use std::f64::consts::PI;

use super::prediction::{Member, Quantity, Shown};
use super::trial::Trial;

const RADIUS_M: f64 = 1e-3;
const DENSITY_KG_M3: f64 = 2500.0;
const YOUNG_PA: f64 = 1e9;
/// Stiffness of the contacts with the bars, N/m: that of the bonds.
const CONTACT_N_M: f64 = YOUNG_PA * PI * RADIUS_M / 2.0;
/// Tolerance of the energy, as for other impacts.
const ENERGY: f64 = 1e-2;

/// A row of five spheres, in a pulse of ten of its own lengths.
fn member(ratio: f64, kind: &str, damping_ratio: f64) -> Member {
    let mass_kg = DENSITY_KG_M3 * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    let impedance_n_s_m = ratio * (CONTACT_N_M * mass_kg).sqrt();
    // Z = sqrt(E rho) A of bars of steel.
    let (young_pa, density): (f64, f64) = (210e9, 7850.0);
    let area_m2 = impedance_n_s_m / (young_pa * density).sqrt();
    let diameter_m = (4.0 * area_m2 / PI).sqrt();
    let (names, direction) = if kind == "hopkinson-tension" {
        (["high", "low"], 1)
    } else {
        (["above", "below"], -1)
    };
    let text = format!(
        "version = 1
run = {{}}
materials.m = {{ density = {DENSITY_KG_M3:e}, young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3 }}
contacts.m-m = {{ law = \"linear\", normal_stiffness = {CONTACT_N_M:e}, restitution = 1, friction = 0 }}
bonds.b = {{ young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.3, damping = {{ damping_ratio = {damping_ratio} }} }}
bodies.row = {{ particles = [[0, 0, 0, 1e-3], [0, 0, 2e-3, 1e-3], [0, 0, 4e-3, 1e-3], [0, 0, 6e-3, 1e-3], [0, 0, 8e-3, 1e-3]], bond_list = [[0, 1], [1, 2], [2, 3], [3, 4]], material = \"m\", bonds = \"b\" }}
groups = {{ low = {{ particles = [0] }}, high = {{ particles = [4] }} }}
walls.above = {{ plane = {{ point = [0, 0, 9e-3], normal = [0, 0, -1] }}, material = \"m\" }}
walls.below = {{ plane = {{ point = [0, 0, -1e-3], normal = [0, 0, 1] }}, material = \"m\" }}
test = {{ type = \"{kind}\", crosshead = [\"{}\"], transmission_bar = \"{}\", direction = [0, 0, {direction}], bars = {{ density = {density:e}, young_modulus = {young_pa:e}, diameter = {diameter_m:e} }}, striker = {{ length = 0.2, velocity = 0.01, rise_time = \"20 us\" }} }}
output = {{ series = 1e-5 }}
",
        names[0], names[1]
    );
    Member::ends(
        format!("{kind}, Z of {ratio:e} of the row, damping_ratio = {damping_ratio}"),
        Trial::of(text),
        vec![Shown::at_most(Quantity::EnergyError, ENERGY)],
    )
}

/// All impedances, for walls and for grips; some with bonds of ten times the critical damping.
pub(super) fn bars() -> Vec<Member> {
    let ratios = [1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6];
    let both = ["hopkinson-pressure", "hopkinson-tension"];
    let undamped = both
        .iter()
        .flat_map(|kind| ratios.map(|ratio| member(ratio, kind, 0.0)));
    let damped = both
        .iter()
        .flat_map(|kind| [1e-3, 1.0, 1e3].map(|ratio| member(ratio, kind, 10.0)));
    undamped.chain(damped).collect()
}
