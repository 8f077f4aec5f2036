//! Bodies with steps of their own: a hard one flies into soft ones.

use super::prediction::{Member, ObservationMethod, Prediction, Quantity, Shown};
use super::trial::Trial;

/// What leapfrog may make the energy swing, of the energy at the start: the fastest modes are near
/// their limit.
const ENERGY_ERROR: f64 = 0.02;
/// Rounding of the momentum.
const MOMENTUM_ERROR: f64 = 1e-11;

/// Four bonded spheres meet two rods of three at rest, one after the other, without damping and
/// friction. The moduli of the materials differ by 10 to 1e6. Energy and momentum are those of the
/// start, although the bodies take steps of up to eight time steps while they fly, and come to one
/// step where they meet.
pub(crate) fn collisions() -> Vec<Member> {
    let member = |ratio: f64| Member {
        what: format!("ratio {ratio:e}"),
        trial: Trial::of(scene(ratio)),
        way: ObservationMethod::Run,
        prediction: Prediction::Ends(vec![
            Shown::at_most(Quantity::EnergyError, ENERGY_ERROR),
            Shown::at_most(Quantity::MomentumError, MOMENTUM_ERROR),
        ]),
    };
    [10.0, 1e2, 1e4, 1e6].into_iter().map(member).collect()
}

fn scene(ratio: f64) -> String {
    let hard_pa = 1e6 * ratio;
    let law = "{ restitution = 1, friction = 0 }";
    format!(
        "version = 1
run = {{ end_time = 0.01, steps_by_body = true }}
materials.soft = {{ density = 2500, young_modulus = 1e6, poisson_ratio = 0.25 }}
materials.hard = {{ density = 2500, young_modulus = {hard_pa:e}, poisson_ratio = 0.25 }}
contacts = {{ soft-soft = {law}, hard-soft = {law}, hard-hard = {law} }}
bonds.soft = {{ young_modulus = 1e6, poisson_ratio = 0.25 }}
bonds.hard = {{ young_modulus = {hard_pa:e}, poisson_ratio = 0.25 }}
[bodies.hard]
particles = [[0, 0, 0, 1e-3], [2e-3, 0, 0, 1e-3], [0, 2e-3, 0, 1e-3], [0, 0, 2e-3, 1e-3]]
bond_list = [[0, 1], [0, 2], [0, 3]]
material = \"hard\"
bonds = \"hard\"
velocity = [2, 0, 0]
[bodies.near]
particles = [[7e-3, -2e-3, 0, 1e-3], [7e-3, 0, 0, 1e-3], [7e-3, 2e-3, 0, 1e-3]]
bond_list = [[0, 1], [1, 2]]
material = \"soft\"
bonds = \"soft\"
[bodies.far]
particles = [[13e-3, 0, -2e-3, 1e-3], [13e-3, 0, 0, 1e-3], [13e-3, 0, 2e-3, 1e-3]]
bond_list = [[0, 1], [1, 2]]
material = \"soft\"
bonds = \"soft\"
"
    )
}
