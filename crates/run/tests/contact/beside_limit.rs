//! The largest stable step with contacts beside bonds.

use dem_engine::check::limit::limit;
use dem_engine::stages::ledger::bookkeeping::balance;
use dem_engine::state::State;
use dem_engine::step::{advance, interact};
use dem_plan::{Plan, plan};
use dem_scene::read_bodies;

use crate::helpers::scene;

const RADIUS_M: f64 = 1e-3;
/// The two spheres overlap by a tenth of a radius.
const LENGTH_M: f64 = 1.9e-3;
/// Contact stiffness over that of the bond.
const HARDER: f64 = 100.0;
const BOND_N_M: f64 = 1e6 * std::f64::consts::PI * RADIUS_M * RADIUS_M / LENGTH_M;

fn planned(run: &str, beside: bool, more: &str) -> Plan {
    let text = format!(
        "version = 1
run = {{ end_time = 1{run} }}
relaxation.min_overlap = 0
materials.m = {{ density = 2500, young_modulus = 1e6, poisson_ratio = 0.3 }}
contacts.m-m = {{ law = \"linear\", normal_stiffness = {:e}, restitution = 1, friction = 0.5 }}
bonds.b = {{ young_modulus = 1e6, poisson_ratio = 0.3, contact_beside_bond = {beside} }}
bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M:e}], [{LENGTH_M:e}, 0, 0, {RADIUS_M:e}]], bond_list = [[0, 1]], material = \"m\", bonds = \"b\" }}
{more}",
        HARDER * BOND_N_M
    );
    let scene = scene(&text);
    plan(&scene, read_bodies(&scene).unwrap(), 1, false).unwrap()
}

/// Limit of the pair, s, with its ends nearer by this distance, m.
fn limit_s(beside: bool, pressed_m: f64) -> f64 {
    let mut state = planned("", beside, "").state;
    state.particles.poses[1].position_m[0] -= pressed_m;
    interact(&mut state);
    limit(&mut state).step_s
}

/// A pressed pair has the stiffness of both along its axis, which is then that of its fastest mode:
/// 2 (k_b + k_c)/m. A pulled one, and one without the key, has that of the bond alone.
#[test]
fn a_pressed_pair_has_the_limit_of_both_stiffnesses() {
    let state: State = planned("", true, "").state;
    let stiffness_n_m = state.bonds.normal(0) + HARDER * BOND_N_M;
    let expected_s = 2.0 / (2.0 * stiffness_n_m * state.particles.motions[0].inverse_mass).sqrt();
    let pressed_s = limit_s(true, 1e-5);
    assert!(
        (pressed_s / expected_s - 1.0).abs() < 1e-6,
        "{pressed_s:e} {expected_s:e}"
    );
    let of_bond_s = limit_s(false, 1e-5);
    assert!(of_bond_s > 5.0 * pressed_s, "{of_bond_s:e}");
    assert_eq!(
        limit_s(true, -1e-5).to_bits(),
        limit_s(false, -1e-5).to_bits()
    );
}

/// The automatic step is below that limit before anything is pressed: a pair that rattles between
/// its contact and its bond keeps its energy.
#[test]
fn a_hard_contact_limits_the_step() {
    let moves = "[groups]
left = { body = \"pair\", particles = [0] }
right = { body = \"pair\", particles = [1] }
[initial]
left = { group = \"left\", velocity = [0.01, 0, 0] }
right = { group = \"right\", velocity = [-0.01, 0, 0] }
";
    let Plan { mut state, .. } = planned("", true, moves);
    let energy_j = 1e-4 / state.particles.motions[0].inverse_mass;
    let (mut largest, mut nearest_m) = (0.0_f64, LENGTH_M);
    while state.time_s < 0.02 {
        interact(&mut state);
        let [a, b] = [0, 1].map(|i| state.particles.poses[i].place());
        nearest_m = nearest_m.min((b - a).norm());
        largest = largest.max(balance(&mut state).energy_error_j.abs() / energy_j);
        advance(&mut state);
    }
    assert!(nearest_m < LENGTH_M, "{nearest_m:e}");
    assert!(largest < 0.05, "{largest}");
}

/// Nothing moves at the start: the step allows for a linear contact all the same, and for a load
/// that presses it later.
#[test]
fn a_load_may_press_a_hard_contact() {
    let load = "groups.right = { particles = [1] }
groups.left = { particles = [0] }
supports.left = { group = \"left\", fixed = true }
loads.press = { group = \"right\", force = [-0.01, 0, 0], ramp = 1e-3 }
";
    let [with, without] = [true, false].map(|beside| planned("", beside, load));
    assert!(with.step.step_s < 0.2 * without.step.step_s);
    let mut state = with.state;
    while state.time_s < 0.01 {
        interact(&mut state);
        assert!(balance(&mut state).energy_error.abs() < 0.05);
        advance(&mut state);
    }
    assert!(state.particles.poses[1].place().x < LENGTH_M);
}
