//! Flat joints with few and with many elements.

use std::f64::consts::PI;

use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;

/// Radius of spheres and bonds, m.
const RADIUS_M: f64 = 1e-3;
/// kg/m3
const DENSITY: f64 = 2500.0;
/// Strength over Young's modulus.
const STRAIN: f64 = 1e-6;
/// Kinetic energy at the start over the energy at the strength.
const EXCESS: f64 = 4.0;
/// Energy error that the verdict of a run permits.
const ENERGY_ERROR: f64 = 0.01;
/// Steps until the joint reaches its strength at the initial speed.
const STEPS: f64 = 200.0;

/// Two spheres fly apart: their joint breaks as a whole and releases what it stored, however many
/// elements it has. A row whose elements fail, rub, open and close creates no energy.
pub(crate) fn joints() -> Vec<Member> {
    let mut members = Vec::new();
    for young_modulus_pa in [1e6, 1e12] {
        for [rings, sectors] in [[1, 3], [3, 12], [50, 50]] {
            members.push(flying_apart(young_modulus_pa, rings, sectors));
        }
    }
    members.push(rattling());
    members
}

fn flying_apart(young_modulus_pa: f64, rings: u32, sectors: u32) -> Member {
    let length_m = 2.0 * RADIUS_M;
    let strength_pa = STRAIN * young_modulus_pa;
    let failure_m = STRAIN * length_m;
    let energy_j = 0.5 * strength_pa * PI * RADIUS_M * RADIUS_M * failure_m;
    let mass_kg = DENSITY * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    // Of each sphere.
    let speed_m_s = (EXCESS * energy_j / mass_kg).sqrt();
    let step_s = 0.5 * failure_m / speed_m_s / STEPS;
    let scene = format!(
        "version = 1
run = {{ end_time = {:e}, time_step = {step_s:e} }}
materials.rock.density = {DENSITY}
bonds.rock = {{ model = \"flat-joint\", radial_elements = {rings}, circumferential_elements = {sectors}, young_modulus = {young_modulus_pa:e}, poisson_ratio = 0.25, failure = {{ tensile_strength = {strength_pa:e} }} }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M}], [{length_m}, 0, 0, {RADIUS_M}]], bond_list = [[0, 1]], material = \"rock\", bonds = \"rock\" }}
groups.left.particles = [0]
groups.right.particles = [1]
initial.left = {{ group = \"left\", velocity = [-{speed_m_s:e}, 0, 0] }}
initial.right = {{ group = \"right\", velocity = [{speed_m_s:e}, 0, 0] }}
measures.kinetic_energy = {{ quantity = \"kinetic_energy\" }}
",
        4.0 * STEPS * step_s,
    );
    Member {
        what: format!("{young_modulus_pa:e} Pa, {rings} x {sectors} elements"),
        trial: Trial::of(scene),
        way: ObservationMethod::Run,
        prediction: Prediction::Ends(vec![
            // Up to a step of the force at the strength.
            Shown::measure(
                "kinetic_energy",
                "J",
                (EXCESS - 1.0) * energy_j,
                2.0 * energy_j / STEPS,
            ),
            Shown::count(Quantity::BrokenBonds, 1),
        ]),
    }
}

/// A row that bends and twists under its own vibration, at half of the limit.
fn rattling() -> Member {
    let spheres: Vec<String> = (0..7)
        .map(|i| format!("[{}, 0, 0, {RADIUS_M}]", 2e-3 * f64::from(i)))
        .collect();
    let mut scene = format!(
        "version = 1
run = {{ end_time = \"20 ms\", safety_factor = 0.5 }}
materials.rock.density = {DENSITY}
bonds.rock = {{ model = \"flat-joint\", joint_friction = 0.5, young_modulus = \"1 GPa\", poisson_ratio = 0.25, damping = {{ damping_ratio = 0.05, per_mode = true }}, failure = {{ tensile_strength = \"1 MPa\", cohesion = \"0.5 MPa\", friction_angle = \"30 deg\" }} }}
bodies.row = {{ particles = [{}], bond_list = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6]], material = \"rock\", bonds = \"rock\" }}
",
        spheres.join(", ")
    );
    for i in 0..7 {
        let phase = PI * f64::from(i) / 6.0;
        let [x, y, spin] = [0.3 * phase.cos(), 0.2 * phase.sin(), 500.0 * phase.cos()];
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
