//! Mohr-Coulomb bonds that are sheared under pressure, and friction after they break.

use std::f64::consts::PI;

use super::prediction::{Member, Quantity, Shown};
use super::trial::Trial;

const RADIUS_M: f64 = 1e-3;
const YOUNG_PA: f64 = 1e9;
/// Normal over shear stiffness of the bond.
const STIFFNESS_RATIO: f64 = 2.5;
const COHESION_PA: f64 = 1e3;
const FRICTION_DEG: f64 = 30.0;
/// Friction of the contact.
const FRICTION: f64 = 0.4;
/// Way beyond the break after which the contact slides, over the radius.
const FARTHER: f64 = 0.02;
/// Permitted error of the force at the end: the tilt of the contact, and what is left of the blow
/// of the break.
const PERMITTED: f64 = 0.02;
/// How near to the closed form a bond holds and breaks.
const MARGIN: f64 = 0.01;

/// Two spheres that a load presses together, with 0.01 to 100 times the cohesion, while one slides
/// past the other. Their bond holds at 0.99 of the way at which its shear stress is c + p tan(phi),
/// and breaks at 1.01 of it; farther on the contact slides at its own friction.
pub(super) fn friction() -> Vec<Member> {
    let pressures = [0.01, 1.0, 100.0];
    let members = pressures.map(|ratio| [holds(ratio), breaks(ratio), slides(ratio)]);
    members.into_iter().flatten().collect()
}

fn area_m2() -> f64 {
    PI * RADIUS_M * RADIUS_M
}

/// Way at which the bond breaks, m.
fn way_m(ratio: f64) -> f64 {
    let strength_pa = COHESION_PA * (1.0 + ratio * FRICTION_DEG.to_radians().tan());
    let shear_n_m = YOUNG_PA * area_m2() / (2.0 * RADIUS_M) / STIFFNESS_RATIO;
    strength_pa * area_m2() / shear_n_m
}

fn holds(ratio: f64) -> Member {
    let shown = vec![Shown::count(Quantity::BrokenBonds, 0)];
    member("holds", ratio, (1.0 - MARGIN) * way_m(ratio), shown)
}

fn breaks(ratio: f64) -> Member {
    let shown = vec![Shown::count(Quantity::BrokenBonds, 1)];
    member("breaks", ratio, (1.0 + MARGIN) * way_m(ratio), shown)
}

fn slides(ratio: f64) -> Member {
    let force_n = ratio * COHESION_PA * area_m2() * (1.0 + FRICTION * FRICTION).sqrt();
    let shown = vec![
        Shown::count(Quantity::BrokenBonds, 1),
        Shown::measure("force", "N", force_n, PERMITTED * force_n),
        Shown::at_most(Quantity::EnergyError, 1e-2),
    ];
    member("slides", ratio, way_m(ratio) + FARTHER * RADIUS_M, shown)
}

fn member(what: &str, ratio: f64, way_m: f64, shown: Vec<Shown>) -> Member {
    let load_n = ratio * COHESION_PA * area_m2();
    let text = format!(
        "version = 1
run = {{ end_time = \"40 ms\", safety_factor = 0.4 }}
materials.rock = {{ density = 2500, young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.25 }}
contacts.rock-rock = {{ restitution = 0.1, friction = {FRICTION} }}
bonds.rock = {{ model = \"parallel\", stiffness_ratio = {STIFFNESS_RATIO}, young_modulus = {YOUNG_PA:e}, poisson_ratio = 0.25, damping = {{ damping_ratio = 0.3 }}, failure = {{ cohesion = {COHESION_PA:e}, friction_angle = \"{FRICTION_DEG} deg\" }} }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = \"rock\", bonds = \"rock\" }}
groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
supports.left = {{ group = \"left\", fixed = true }}
supports.right = {{ group = \"right\", fixed = [\"z\", \"rx\", \"ry\", \"rz\"], displacement = {{ y = {way_m:e} }}, table = [[0.01, 0], [0.04, 1]] }}
loads.press = {{ group = \"right\", force = [{:e}, 0, 0], ramp = 0.005 }}
measures.force = {{ of = \"right\", with = \"left\", quantity = \"contact_force\" }}
",
        2.0 * RADIUS_M,
        -load_n
    );
    Member::ends(
        format!("pressure {ratio:e} of the cohesion, {what}"),
        Trial::of(text),
        shown,
    )
}
