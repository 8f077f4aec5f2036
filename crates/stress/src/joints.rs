//! Flat joints with few and with many elements.

use std::f64::consts::PI;

use super::bonded::{self, RADIUS_M, STRAIN, mass_kg, momenta_stay};
use super::prediction::{Member, Quantity, Shown};

/// Kinetic energy at the start over the energy at the strength.
const EXCESS: f64 = 4.0;
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
    // Of each sphere.
    let speed_m_s = (EXCESS * energy_j / mass_kg()).sqrt();
    let step_s = 0.5 * failure_m / speed_m_s / STEPS;
    let bonds = format!(
        "model = \"flat-joint\", radial_elements = {rings}, circumferential_elements = {sectors}, young_modulus = {young_modulus_pa:e}, failure = {{ tensile_strength = {strength_pa:e} }}"
    );
    let measures = "measures.kinetic_energy = { quantity = \"kinetic_energy\" }";
    let times_s = [4.0 * STEPS * step_s, step_s];
    Member::ends(
        format!("{young_modulus_pa:e} Pa, {rings} x {sectors} elements"),
        bonded::flying_apart(times_s, &bonds, speed_m_s, measures),
        vec![
            // Up to a step of the force at the strength.
            Shown::measure(
                "kinetic_energy",
                "J",
                (EXCESS - 1.0) * energy_j,
                2.0 * energy_j / STEPS,
            ),
            Shown::count(Quantity::BrokenBonds, 1),
        ],
    )
}

/// A row that bends and twists under its own vibration, at half of the limit.
fn rattling() -> Member {
    let bonds = "model = \"flat-joint\", joint_friction = 0.5, damping = { damping_ratio = 0.05, per_mode = true }, failure = { tensile_strength = \"1 MPa\", cohesion = \"0.5 MPa\", friction_angle = \"30 deg\" }";
    let motion = |phase: f64| [0.3 * phase.cos(), 0.2 * phase.sin(), 500.0 * phase.cos()];
    bonded::row(bonded::rattling("20 ms", bonds, motion, ""), momenta_stay())
}
