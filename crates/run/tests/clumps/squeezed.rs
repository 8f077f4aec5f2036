//! Clumps that are replaced when two sides squeeze them, while the sum of the forces stays 0.

use std::f64::consts::PI;

use dem_engine::state::State;
use dem_engine::state::events::PopulationEvent;

use super::{HEAD, block, happens, planned};

const STEP_S: f64 = 1e-6;
const RADIUS_M: f64 = 1e-3;
const SPEED_M_S: f64 = 0.02;
/// Volume of the two spheres of the clump, m3.
const VOLUME_M3: f64 = 8.0 / 3.0 * PI * RADIUS_M * RADIUS_M * RADIUS_M;

/// A clump of two spheres beside or above each other, and what closes in on it at equal speeds from
/// above and below.
fn squeezed(counts: [i32; 3], between: &str, when: &str) -> State {
    let start = "start_as = \"clump\"";
    let pair = block("pair", counts, 2.0 * RADIUS_M, |_| Some(RADIUS_M), start);
    let mut plan = planned(&format!(
        "{HEAD}contacts.stuff-stuff = {{ restitution = 1, friction = 0 }}\n{pair}{between}\
         [replacement.pair]\nwhen = {when}\n"
    ));
    plan.state.time_step_s = STEP_S;
    plan.state
}

/// Plates that begin at the surface of spheres side by side.
fn between_plates(when: &str) -> State {
    let plates = format!(
        "[walls.below]\nplane = {{ point = [0, 0, {}], normal = [0, 0, 1] }}\nmaterial = \"stuff\"\nvelocity = [0, 0, {SPEED_M_S}]\n\
         [walls.above]\nplane = {{ point = [0, 0, {RADIUS_M}], normal = [0, 0, -1] }}\nmaterial = \"stuff\"\nvelocity = [0, 0, {}]\n",
        -RADIUS_M, -SPEED_M_S
    );
    squeezed([2, 1, 1], &plates, when)
}

/// Balls that begin at the ends of spheres above each other, the lower one at the origin.
fn between_balls(when: &str) -> State {
    let ball = |name: &str, z_m: f64, speed_m_s: f64| {
        format!(
            "[bodies.{name}]\nmaterial = \"stuff\"\nparticles = [[0, 0, {z_m}, {RADIUS_M}]]\n\
             [supports.{name}]\ngroup = \"{name}\"\nvelocity.z = {speed_m_s}\n"
        )
    };
    let balls =
        ball("below", -2.0 * RADIUS_M, SPEED_M_S) + &ball("above", 4.0 * RADIUS_M, -SPEED_M_S);
    squeezed([1, 1, 2], &balls, when)
}

/// The time at which the clump is replaced, s, and the cause.
fn replaced(mut state: State) -> Option<(f64, &'static str)> {
    while state.time_s < 2e-3 {
        let now_s = state.time_s;
        if let [PopulationEvent::Replaced { cause, .. }] = happens(&mut state)[..] {
            return Some((now_s, cause));
        }
    }
    None
}

/// Force of a contact of Hertz after this time, N. `radius_m`: the effective radius.
fn force_n(time_s: f64, overlap_m_s: f64, radius_m: f64) -> f64 {
    let modulus_pa = 1e8 / (2.0 * (1.0 - 0.0625));
    4.0 / 3.0 * modulus_pa * radius_m.sqrt() * (overlap_m_s * time_s).powf(1.5)
}

/// The replacement happens in the step in which the closed form passes the limit.
fn assert_at(found: Option<(f64, &str)>, cause: &str, limit: f64, value: impl Fn(f64) -> f64) {
    let (at_s, found) = found.unwrap();
    assert_eq!(found, cause);
    let [before, now] = [value(at_s - STEP_S), value(at_s)];
    // Positions are those of a sum of steps.
    assert!(before <= limit * (1.0 + 1e-9), "{before} {limit}");
    assert!(now >= limit * (1.0 - 1e-9), "{now} {limit}");
}

#[test]
fn plates_squeeze_with_forces_that_cancel() {
    let one_n = |time_s: f64| force_n(time_s, SPEED_M_S, RADIUS_M);
    let stress_pa = |time_s: f64| {
        let arm_m = RADIUS_M - SPEED_M_S * time_s;
        4.0 * one_n(time_s) * arm_m / VOLUME_M3
    };
    let limit_n = one_n(1e-3);
    let when = format!("{{ contact_force = {limit_n} }}");
    assert_at(
        replaced(between_plates(&when)),
        "contact_force",
        limit_n,
        one_n,
    );
    let limit_pa = stress_pa(1.3e-3);
    let when = format!("{{ principal_stress = {limit_pa} }}");
    let found = replaced(between_plates(&when));
    assert_at(found, "principal_stress", limit_pa, stress_pa);
    // The resultant sees nothing.
    let when = format!("{{ force = {} }}", 1e-6 * limit_n);
    assert_eq!(replaced(between_plates(&when)), None);
}

#[test]
fn balls_squeeze_as_plates_do() {
    let one_n = |time_s: f64| force_n(time_s, SPEED_M_S, 0.5 * RADIUS_M);
    let stress_pa = |time_s: f64| {
        let arm_m = 2.0 * RADIUS_M - 0.5 * SPEED_M_S * time_s;
        2.0 * one_n(time_s) * arm_m / VOLUME_M3
    };
    let limit_n = one_n(1e-3);
    let when = format!("{{ contact_force = {limit_n} }}");
    assert_at(
        replaced(between_balls(&when)),
        "contact_force",
        limit_n,
        one_n,
    );
    let limit_pa = stress_pa(1.3e-3);
    let when = format!("{{ principal_stress = {limit_pa} }}");
    let found = replaced(between_balls(&when));
    assert_at(found, "principal_stress", limit_pa, stress_pa);
    // Both at once wait for the later one.
    let when = format!(
        "{{ contact_force = {limit_n}, principal_stress = {limit_pa} }}\nrequire = \"all\""
    );
    let (at_s, cause) = replaced(between_balls(&when)).unwrap();
    assert_eq!(cause, "contact_force");
    assert!((at_s - 1.3e-3).abs() < 2.0 * STEP_S, "{at_s}");
}
