//! Bonds that soften until their fracture energy is spent.

use std::f64::consts::PI;

use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;

/// Radius of spheres and bonds, m.
const RADIUS_M: f64 = 1e-3;
/// kg/m3
const DENSITY: f64 = 2500.0;
/// Strength over Young's modulus.
const STRAIN: f64 = 1e-6;
/// Kinetic energy at the start over the fracture energy.
const EXCESS: f64 = 1.5;
/// Energy error that the verdict of a run permits.
const ENERGY_ERROR: f64 = 0.01;
/// Steps until the bond breaks if nothing held it.
const STEPS: f64 = 100.0;

/// Two spheres fly apart. Their bond takes its fracture energy, whatever the opening at which it
/// breaks is over that at its strength, and the rest of the kinetic energy is left. A row whose
/// damaged bonds open and close creates no energy.
pub(crate) fn softening() -> Vec<Member> {
    let mut members = Vec::new();
    for young_modulus_pa in [1e6, 1e12] {
        for ratio in [1.5, 100.0, 1e4] {
            members.push(flying_apart(young_modulus_pa, ratio));
        }
    }
    members.push(rattling());
    members
}

fn flying_apart(young_modulus_pa: f64, ratio: f64) -> Member {
    let length_m = 2.0 * RADIUS_M;
    let strength_pa = STRAIN * young_modulus_pa;
    let energy_j_m2 = 0.5 * ratio * strength_pa * STRAIN * length_m;
    let energy_j = energy_j_m2 * PI * RADIUS_M * RADIUS_M;
    let mass_kg = DENSITY * 4.0 / 3.0 * PI * RADIUS_M.powi(3);
    // Of each sphere.
    let speed_m_s = (EXCESS * energy_j / mass_kg).sqrt();
    let broken_m = 2.0 * energy_j_m2 / strength_pa;
    let step_s = 0.5 * broken_m / speed_m_s / STEPS;
    let scene = format!(
        "version = 1
run = {{ end_time = {:e}, time_step = {step_s:e} }}
materials.rock.density = {DENSITY}
bonds.rock = {{ young_modulus = {young_modulus_pa:e}, poisson_ratio = 0.25, failure = {{ tensile_strength = {strength_pa:e}, fracture_energy = {energy_j_m2:e} }} }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M}], [{length_m}, 0, 0, {RADIUS_M}]], bond_list = [[0, 1]], material = \"rock\", bonds = \"rock\" }}
groups.left.particles = [0]
groups.right.particles = [1]
initial.left = {{ group = \"left\", velocity = [-{speed_m_s:e}, 0, 0] }}
initial.right = {{ group = \"right\", velocity = [{speed_m_s:e}, 0, 0] }}
measures.kinetic_energy = {{ quantity = \"kinetic_energy\" }}
",
        4.0 * STEPS * step_s,
    );
    let left_j = (EXCESS - 1.0) * energy_j;
    Member {
        what: format!("{young_modulus_pa:e} Pa, opening ratio {ratio:e}"),
        trial: Trial::of(scene),
        way: ObservationMethod::Run,
        // One step at the strength: up to it the force is taken for half a step.
        prediction: Prediction::Ends(vec![
            Shown::measure("kinetic_energy", "J", left_j, energy_j / STEPS),
            Shown::count(Quantity::BrokenBonds, 1),
        ]),
    }
}

/// A row with a twentieth of critical damping, at half of the limit: its energy is as good as the
/// verdict of a run asks for.
fn rattling() -> Member {
    let spheres: Vec<String> = (0..7)
        .map(|i| format!("[{}, 0, 0, {RADIUS_M}]", 2e-3 * f64::from(i)))
        .collect();
    let mut scene = format!(
        "version = 1
run = {{ end_time = \"50 ms\", safety_factor = 0.5 }}
materials.rock.density = {DENSITY}
bonds.rock = {{ young_modulus = \"1 GPa\", poisson_ratio = 0.25, damping = {{ damping_ratio = 0.05, per_mode = true }}, failure = {{ tensile_strength = \"1 MPa\", fracture_energy = \"40 J/m2\" }} }}
bodies.row = {{ particles = [{}], bond_list = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6]], material = \"rock\", bonds = \"rock\" }}
measures.elastic_energy = {{ quantity = \"elastic_energy\"}}
",
        spheres.join(", ")
    );
    for i in 0..7 {
        let phase = PI * f64::from(i) / 6.0;
        let velocity_m_s = [-phase.cos(), 0.1 * phase.sin()].map(|v| 2.0 * v);
        scene += &format!(
            "groups.g{i}.particles = [{i}]\ninitial.i{i} = {{ group = \"g{i}\", velocity = [{}, {}, 0] }}\n",
            velocity_m_s[0], velocity_m_s[1]
        );
    }
    Member {
        what: "row at half of the limit".to_owned(),
        trial: Trial::of(scene),
        way: ObservationMethod::Run,
        prediction: Prediction::Ends(vec![
            Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
            Shown::measure("elastic_energy", "J", 0.0, 1e-9),
            Shown::count(Quantity::BrokenBonds, 0),
        ]),
    }
}
