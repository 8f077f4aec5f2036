//! Bonds that yield and flow.

use std::f64::consts::PI;

use super::bonded::{self, RADIUS_M, STRAIN, mass_kg, momenta_stay};
use super::prediction::{Member, Shown};

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
    // Of each sphere.
    let speed_m_s = (excess * 0.5 * yield_n * yield_m / mass_kg()).sqrt();
    // Beyond yield, in units of the deformation at yield: (excess - 1)/2 = x + h x^2/2.
    let beyond = (excess - 1.0) / (1.0 + (1.0 + hardening * (excess - 1.0)).sqrt());
    // Twice as long as the bond flows.
    let end_s = 4.0 * (1.0 + beyond) * 0.5 * yield_m / speed_m_s;
    let step_s = end_s / STEPS;
    let bonds = format!(
        "young_modulus = {young_modulus_pa:e}, plasticity = {{ normal_yield_strength = {strength_pa:e}, hardening_ratio = {hardening} }}"
    );
    let measures = "measures.displacement = { of = \"right\", quantity = \"displacement_x\", statistic = \"largest\" }
measures.elastic_energy = { quantity = \"elastic_energy\", statistic = \"largest\" }";
    let largest_m = 0.5 * yield_m * (1.0 + beyond);
    let load = 1.0 + hardening * beyond;
    let elastic_j = 0.5 * yield_n * yield_m * load * load;
    Member::ends(
        format!("{young_modulus_pa:e} Pa, energy {excess:e}, hardening {hardening}"),
        bonded::flying_apart([end_s, step_s], &bonds, speed_m_s, measures),
        vec![
            Shown::measure("displacement", "m", largest_m, PERMITTED * largest_m),
            Shown::measure("elastic_energy", "J", elastic_j, PERMITTED * elastic_j),
        ],
    )
}

/// A row whose bonds yield in all modes, with hardening, at half of the limit.
fn rattling() -> Member {
    let bonds = "plasticity = { normal_yield_strength = \"0.3 MPa\", shear_yield_strength = \"0.3 MPa\", torsion_yield_strength = \"0.3 MPa\", bending_yield_strength = \"0.3 MPa\", hardening_ratio = 0.1 }";
    let motion = |phase: f64| [-phase.cos(), 0.5 * phase.sin(), 200.0 * phase.cos()];
    bonded::row(bonded::rattling("50 ms", bonds, motion, ""), momenta_stay())
}
