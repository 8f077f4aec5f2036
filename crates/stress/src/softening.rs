//! Bonds that soften until their fracture energy is spent.

use std::f64::consts::PI;

use super::bonded::{self, RADIUS_M, STRAIN, mass_kg};
use super::prediction::{Member, Quantity, Shown};
use super::trial::Trial;

/// Kinetic energy at the start over the fracture energy.
const EXCESS: f64 = 1.5;
/// Steps until the bond breaks if nothing held it.
const STEPS: f64 = 100.0;

/// Two spheres fly apart. Their bond takes its fracture energy, whatever the opening at which it
/// breaks is over that at its strength, and the rest of the kinetic energy is left. A row whose
/// damaged bonds open and close creates no energy.
pub(crate) fn softening() -> Vec<Member> {
    let mut members = Vec::new();
    for young_modulus_pa in [1e6, 1e12] {
        for ratio in [1.5, 100.0, 1e4] {
            members.push(flying_apart(young_modulus_pa, ratio, &TENSION));
        }
        for criterion in [&MOHR_COULOMB, &VON_MISES] {
            members.push(flying_apart(young_modulus_pa, 100.0, criterion));
        }
    }
    members.push(rattling());
    members.extend([(0.4, [0.01, 0.3]), (0.05, [0.0, 0.005])].map(undamped));
    members
}

/// A strength that axial tension alone reaches at the same stress as the others.
struct Criterion {
    name: &'static str,
    /// Its key, to be followed by the strength, and keys that go with it.
    keys: [&'static str; 2],
    /// Normal stiffness over that by which its opening is reckoned.
    softer: f64,
}

const TENSION: Criterion = Criterion {
    name: "tensile strength",
    keys: ["tensile_strength", ""],
    softer: 1.0,
};
const VON_MISES: Criterion = Criterion {
    name: "equivalent stress",
    keys: ["von_mises_strength", ""],
    softer: 1.0,
};
/// Tension times the tangent is the shear stress at which it fails; openings are those of shear.
const MOHR_COULOMB: Criterion = Criterion {
    name: "Mohr-Coulomb",
    keys: ["cohesion", ", friction_angle = \"45 deg\""],
    softer: STIFFNESS_RATIO,
};
/// Normal over shear stiffness of the bond.
const STIFFNESS_RATIO: f64 = 2.5;

fn flying_apart(young_modulus_pa: f64, ratio: f64, criterion: &Criterion) -> Member {
    let length_m = 2.0 * RADIUS_M;
    let strength_pa = STRAIN * young_modulus_pa;
    let broken_m = ratio * STRAIN * length_m;
    let energy_j = 0.5 * strength_pa * broken_m * PI * RADIUS_M * RADIUS_M;
    // Of each sphere.
    let speed_m_s = (EXCESS * energy_j / mass_kg()).sqrt();
    let step_s = 0.5 * broken_m / speed_m_s / STEPS;
    // That of its own opening, of which tension takes a part.
    let energy_j_m2 = criterion.softer * 0.5 * strength_pa * broken_m;
    let [key, more] = criterion.keys;
    let bonds = format!(
        "model = \"parallel\", stiffness_ratio = {STIFFNESS_RATIO}, young_modulus = {young_modulus_pa:e}, failure = {{ {key} = {strength_pa:e}{more}, fracture_energy = {energy_j_m2:e} }}"
    );
    let measures = "measures.kinetic_energy = { quantity = \"kinetic_energy\" }";
    let times_s = [4.0 * STEPS * step_s, step_s];
    let left_j = (EXCESS - 1.0) * energy_j;
    Member::ends(
        format!(
            "{young_modulus_pa:e} Pa, {}, opening ratio {ratio:e}",
            criterion.name
        ),
        bonded::flying_apart(times_s, &bonds, speed_m_s, measures),
        // One step at the strength: up to it the force is taken for half a step.
        vec![
            Shown::measure("kinetic_energy", "J", left_j, energy_j / STEPS),
            Shown::count(Quantity::BrokenBonds, 1),
        ],
    )
}

/// A row with a twentieth of critical damping, at half of the limit: its energy is as good as the
/// verdict of a run asks for.
fn rattling() -> Member {
    let bonds = "damping = { damping_ratio = 0.05, per_mode = true }, failure = { tensile_strength = \"1 MPa\", fracture_energy = \"40 J/m2\" }";
    let motion = |phase: f64| [-2.0 * phase.cos(), 2.0 * (0.1 * phase.sin()), 0.0];
    let measures = "measures.elastic_energy = { quantity = \"elastic_energy\"}";
    let trial = bonded::rattling("50 ms", bonds, motion, measures);
    let comes_to_rest = [
        Shown::measure("elastic_energy", "J", 0.0, 1e-9),
        Shown::count(Quantity::BrokenBonds, 0),
    ];
    bonded::row(trial, comes_to_rest)
}

/// The same row without damping, at this fraction of the limit, whose energy error lies between
/// these. The stiffness of a damaged bond jumps where it closes: leapfrog creates energy there, by
/// the square of the step.
fn undamped((fraction, [least, largest]): (f64, [f64; 2])) -> Member {
    let bonds = "failure = { tensile_strength = \"1 MPa\", fracture_energy = \"40 J/m2\" }";
    let motion = |phase: f64| [-2.0 * phase.cos(), 2.0 * (0.1 * phase.sin()), 0.0];
    let trial = bonded::rattling("20 ms", bonds, motion, "");
    let scene = trial.scene.replace(
        "safety_factor = 0.5",
        &format!("safety_factor = {fraction}"),
    );
    Member::ends(
        format!("undamped row at {fraction} of the limit"),
        Trial { scene, ..trial },
        vec![
            Shown::between(Quantity::EnergyError, "", least, largest),
            Shown::count(Quantity::BrokenBonds, 0),
        ],
    )
}
