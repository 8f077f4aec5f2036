//! Bonds that yield and flow.

use std::f64::consts::PI;

use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;

/// Radius of spheres and bonds, m.
const RADIUS_M: f64 = 1e-3;
/// kg/m3
const DENSITY: f64 = 2500.0;
/// Yield strength over Young's modulus.
const STRAIN: f64 = 1e-6;
/// Energy error that the verdict of a run permits.
const ENERGY_ERROR: f64 = 0.01;
/// Steps of a flight.
const STEPS: f64 = 4000.0;
/// Permitted relative error.
const PERMITTED: f64 = 1e-3;

/// Two spheres fly apart with up to ten thousand times the energy at which their bond yields, and
/// come to rest where its work has used that up. A row that rattles and flows in all modes creates
/// no energy.
pub(crate) fn yielding() -> Vec<Member> {
    let mut members = Vec::new();
    for young_modulus_pa in [1e6, 1e12] {
        for (excess, hardening) in [(2.0, 0.0), (100.0, 0.1), (1e4, 0.0), (1e4, 0.5)] {
            members.push(flying_apart(young_modulus_pa, excess, hardening));
        }
    }
    members.push(rattling());
    members
}

fn flying_apart(young_modulus_pa: f64, excess: f64, hardening: f64) -> Member {
    let length_m = 2.0 * RADIUS_M;
    let strength_pa = STRAIN * young_modulus_pa;
    let yield_m = STRAIN * length_m;
    let yield_n = strength_pa * PI * RADIUS_M * RADIUS_M;
    let mass_kg = DENSITY * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    // Of each sphere.
    let speed_m_s = (excess * 0.5 * yield_n * yield_m / mass_kg).sqrt();
    // Beyond yield, in units of the deformation at yield: (excess - 1)/2 = x + h x^2/2.
    let beyond = (excess - 1.0) / (1.0 + (1.0 + hardening * (excess - 1.0)).sqrt());
    // Twice as long as the bond flows.
    let end_s = 4.0 * (1.0 + beyond) * 0.5 * yield_m / speed_m_s;
    let step_s = end_s / STEPS;
    let scene = format!(
        "version = 1
run = {{ end_time = {end_s:e}, time_step = {step_s:e} }}
materials.metal.density = {DENSITY}
bonds.metal = {{ young_modulus = {young_modulus_pa:e}, poisson_ratio = 0.25, plasticity = {{ normal_yield_strength = {strength_pa:e}, hardening_ratio = {hardening} }} }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M}], [{length_m}, 0, 0, {RADIUS_M}]], bond_list = [[0, 1]], material = \"metal\", bonds = \"metal\" }}
groups.left.particles = [0]
groups.right.particles = [1]
initial.left = {{ group = \"left\", velocity = [-{speed_m_s:e}, 0, 0] }}
initial.right = {{ group = \"right\", velocity = [{speed_m_s:e}, 0, 0] }}
measures.displacement = {{ of = \"right\", quantity = \"displacement_x\", statistic = \"largest\" }}
measures.elastic_energy = {{ quantity = \"elastic_energy\", statistic = \"largest\" }}
"
    );
    let largest_m = 0.5 * yield_m * (1.0 + beyond);
    let load = 1.0 + hardening * beyond;
    let elastic_j = 0.5 * yield_n * yield_m * load * load;
    Member {
        what: format!("{young_modulus_pa:e} Pa, energy {excess:e}, hardening {hardening}"),
        trial: Trial::of(scene),
        way: ObservationMethod::Run,
        prediction: Prediction::Ends(vec![
            Shown::measure("displacement", "m", largest_m, PERMITTED * largest_m),
            Shown::measure("elastic_energy", "J", elastic_j, PERMITTED * elastic_j),
        ]),
    }
}

/// A row whose bonds yield in all modes, with hardening, at the step that the program chooses.
fn rattling() -> Member {
    let spheres: Vec<String> = (0..7)
        .map(|i| format!("[{}, 0, 0, {RADIUS_M}]", 2e-3 * f64::from(i)))
        .collect();
    let mut scene = format!(
        "version = 1
run = {{ end_time = \"50 ms\", safety_factor = 0.5 }}
materials.metal.density = {DENSITY}
bonds.metal = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25, plasticity = {{ normal_yield_strength = \"0.3 MPa\", shear_yield_strength = \"0.3 MPa\", torsion_yield_strength = \"0.3 MPa\", bending_yield_strength = \"0.3 MPa\", hardening_ratio = 0.1 }} }}
bodies.row = {{ particles = [{}], bond_list = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6]], material = \"metal\", bonds = \"metal\" }}
",
        spheres.join(", ")
    );
    for i in 0..7 {
        let phase = PI * f64::from(i) / 6.0;
        let [x, y, spin] = [-phase.cos(), 0.5 * phase.sin(), 200.0 * phase.cos()];
        scene += &format!(
            "groups.g{i}.particles = [{i}]\ninitial.i{i} = {{ group = \"g{i}\", velocity = [{x}, {y}, 0], angular_velocity = [{spin}, 0, {spin}] }}\n"
        );
    }
    Member {
        what: "row at half of the limit".to_owned(),
        trial: Trial::of(scene),
        way: ObservationMethod::Run,
        prediction: Prediction::Ends(vec![
            Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
            Shown::at_most(Quantity::MomentumError, 1e-9),
            Shown::at_most(Quantity::AngularMomentumError, 1e-9),
        ]),
    }
}
