//! Flat joints: stiffness of their elements, and a joint that opens under pressure.

use std::f64::consts::PI;

use dem_run::step::{advance, interact};
use dem_run::{State, balance, step};

use super::page::{assert_shown, filled, on_one_thread};
use super::scene::started;
use super::table::{Case, compared};

const RADIUS_M: f64 = 1e-3;
const LENGTH_M: f64 = 2e-3;
const YOUNG_PA: f64 = 1e9;
const POISSON: f64 = 0.25;
/// Time in which a load or a rotation rises, s.
const RAMP_S: f64 = 4e-3;

/// A pair whose joint has these elements, and further keys and tables.
fn pair(rings: u32, sectors: u32, keys: &str, more: &str) -> State {
    started(&format!(
        r#"
        version = 1
        run = {{ end_time = 1, time_step = 1e-6 }}
        materials.rock = {{ density = 2500 }}
        bonds.rock = {{ model = "flat-joint", radial_elements = {rings}, circumferential_elements = {sectors}, young_modulus = {YOUNG_PA:e}, poisson_ratio = {POISSON}{keys} }}
        bodies.pair = {{ particles = [[0, 0, 0, {RADIUS_M}], [{LENGTH_M}, 0, 0, {RADIUS_M}]], bond_list = [[0, 1]], material = "rock", bonds = "rock" }}
        groups = {{ left = {{ particles = [0] }}, right = {{ particles = [1] }} }}
        {more}
        "#
    ))
}

/// A support that rotates an end about an axis, rad, and holds the axes named.
fn rotated(side: &str, fixed: &str, axis: &str, angle: f64) -> String {
    format!(
        "supports.{side} = {{ group = \"{side}\", fixed = [{fixed}], displacement = {{ {axis} = {angle:e} }}, ramp = {RAMP_S} }}\n"
    )
}

/// Moment over angle of a joint whose ends are rotated against each other by a small angle.
fn stiffness(rings: u32, sectors: u32, axis: &str) -> f64 {
    let angle = 1e-6;
    let others = if axis == "rx" {
        r#""x", "y", "z", "ry", "rz""#
    } else {
        r#""x", "y", "z", "rx", "ry""#
    };
    let supports =
        rotated("left", others, axis, -0.5 * angle) + &rotated("right", others, axis, 0.5 * angle);
    let mut state = pair(rings, sectors, "", &supports);
    while state.time_s < 1.5 * RAMP_S {
        step(&mut state);
    }
    let load = state.bonds.forces(0, &state.particles.poses).load;
    load.torsion_n_m.max(load.bending_n_m) / angle
}

/// Sum of area times distance squared of the centroids of all elements, over that of the disc.
fn moment_ratio(rings: u32, sectors: u32) -> f64 {
    let n = f64::from(rings);
    let half = PI / f64::from(sectors);
    let rings = (0..rings).map(|k| {
        let k = f64::from(k);
        let centroid = 2.0 / 3.0 * (3.0 * k * k + 3.0 * k + 1.0) / (2.0 * k + 1.0) / n;
        2.0 * (2.0 * k + 1.0) / (n * n) * centroid * centroid
    });
    rings.sum::<f64>() * (half.sin() / half).powi(2)
}

fn by_elements() -> [String; 2] {
    let second_moment = PI / 4.0 * RADIUS_M.powi(4);
    let shear_modulus_pa = YOUNG_PA / (2.0 * (1.0 + POISSON));
    let of_disc = [
        ("rz", YOUNG_PA * second_moment / LENGTH_M),
        ("rx", 2.0 * shear_modulus_pa * second_moment / LENGTH_M),
    ];
    of_disc.map(|(axis, of_disc)| {
        let cases = [(1, 3), (1, 12), (2, 8), (3, 12), (6, 24), (12, 48)];
        let cases = cases.map(|(rings, sectors)| {
            Case::new(
                format!("{rings} x {sectors}"),
                stiffness(rings, sectors, axis) / of_disc,
                moment_ratio(rings, sectors),
                1e-9,
            )
        });
        compared("elements", "", &cases)
    })
}

/// Axial force and moment of a rigid disc of the radius 1 on a foundation of the stiffness 1 that
/// only presses, turned by the angle 1 about an axis in its plane, where it touches beyond cos(a).
fn rigid_disc(a: f64) -> [f64; 2] {
    let (sine, cosine) = a.sin_cos();
    let area = a - sine * cosine;
    let first = 2.0 / 3.0 * sine.powi(3);
    let second = 0.25 * (area + 2.0 * sine.powi(3) * cosine);
    [first - cosine * area, second - cosine * first]
}

/// Moment of a joint that is pressed by a stress and then rotated by an angle, N m.
fn opened(elements: [u32; 2], pressure_pa: f64, angle: f64) -> f64 {
    let force_n = pressure_pa * PI * RADIUS_M * RADIUS_M;
    let turn = |side: &str, fixed: &str, angle: f64| {
        format!(
            "supports.{side} = {{ group = \"{side}\", fixed = [{fixed}], displacement = {{ rz = {angle:e} }}, table = [[0, 0], [{RAMP_S}, 0], [{:e}, 1]] }}\n",
            4.0 * RAMP_S
        )
    };
    let more = turn("left", r#""x", "y", "z", "rx", "ry""#, -0.5 * angle)
        + &turn("right", r#""y", "z", "rx", "ry""#, 0.5 * angle)
        + &format!(
            "loads.right = {{ group = \"right\", force = [{:e}, 0, 0], ramp = {RAMP_S} }}\n",
            -force_n
        );
    let keys = ", damping = { damping_ratio = 1 }, failure = { tensile_strength = 1e-3 }";
    let mut state = pair(elements[0], elements[1], keys, &more);
    while state.time_s < 5.0 * RAMP_S {
        step(&mut state);
    }
    let load = state.bonds.forces(0, &state.particles.poses).load;
    load.bending_n_m
}

fn by_opening() -> String {
    let pressure_pa = 1e4;
    let cases = [150.0_f64, 120.0, 90.0, 60.0].map(|degrees| {
        let [axial, moment] = rigid_disc(degrees.to_radians());
        let per_area = YOUNG_PA / LENGTH_M;
        let angle = pressure_pa * PI / (axial * per_area * RADIUS_M);
        let expected = moment * angle * per_area * RADIUS_M.powi(4);
        let found = opened([16, 64], pressure_pa, angle);
        let scale = pressure_pa * PI * RADIUS_M.powi(3);
        Case::new(format!("{degrees}"), found / scale, expected / scale, 5e-3)
    });
    compared("half angle of contact, degrees", "", &cases)
}

/// The way of a support over that at which a joint fails.
const BEYOND: f64 = 1.53;

/// Steps until a joint has done what `done` asks for.
fn until(state: &mut State, done: impl Fn(&State) -> bool) {
    loop {
        interact(state);
        if done(state) {
            return;
        }
        assert!(state.time_s < RAMP_S, "it does not happen");
        advance(state);
    }
}

/// A joint that is pulled apart: the stress at which all its elements fail, and what that releases.
fn pulled(strength_pa: f64) -> [Case; 2] {
    let end_m = BEYOND * strength_pa / YOUNG_PA * LENGTH_M;
    let keys = format!(", failure = {{ tensile_strength = {strength_pa:e} }}");
    let more = format!(
        "supports.left = {{ group = \"left\", fixed = true }}
         supports.right = {{ group = \"right\", fixed = [\"y\", \"z\", \"rx\", \"ry\", \"rz\"], displacement = {{ x = {end_m:e} }}, ramp = {RAMP_S} }}\n"
    );
    let mut state = pair(3, 12, &keys, &more);
    until(&mut state, |state| state.broken_count > 0);
    let [a, b] = [0, 1].map(|i| state.particles.poses[i].place().x);
    let stress_pa = YOUNG_PA * (b - a - LENGTH_M) / LENGTH_M;
    let volume_m3 = PI * RADIUS_M * RADIUS_M * LENGTH_M;
    let stored_j = 0.5 * strength_pa * strength_pa / YOUNG_PA * volume_m3;
    let released_j = balance(&mut state).bond_breakage_j;
    // A step of the displacement.
    let bound = BEYOND * 1e-6 / RAMP_S;
    let what = |what: &str| format!("tension: {what}");
    [
        Case::new(
            what("stress at failure, MPa"),
            1e-6 * stress_pa,
            1e-6 * strength_pa,
            bound,
        ),
        Case::new(
            what("energy released, uJ"),
            1e6 * released_j,
            1e6 * stored_j,
            2.0 * bound,
        ),
    ]
}

/// A joint that is bent: the angle at which its first element fails, that farthest from the axis.
fn bent(strength_pa: f64, rings: u32, sectors: u32) -> Case {
    let half = PI / f64::from(sectors);
    let k = f64::from(rings - 1);
    let centroid_m = 2.0 / 3.0 * (3.0 * k * k + 3.0 * k + 1.0) / (2.0 * k + 1.0) / f64::from(rings)
        * half.sin()
        / half
        * RADIUS_M;
    // The axis of an element is half a sector off those of the bond, or on one.
    let farthest = |sector: u32| ((2.0 * f64::from(sector) + 1.0) * half).cos().abs();
    let across = (0..sectors).map(farthest).fold(0.0, f64::max);
    let wanted = strength_pa / (YOUNG_PA / LENGTH_M) / (centroid_m * across);
    let end = BEYOND * wanted;
    let others = r#""x", "y", "z", "rx", "ry""#;
    let keys = format!(", failure = {{ tensile_strength = {strength_pa:e} }}");
    let more =
        rotated("left", others, "rz", -0.5 * end) + &rotated("right", others, "rz", 0.5 * end);
    let mut state = pair(rings, sectors, &keys, &more);
    until(&mut state, |state| {
        state.bonds.histories.joints[0].failed_fraction() > 0.0
    });
    assert_eq!(state.broken_count, 0);
    let found = end * state.time_s / RAMP_S;
    let what = format!("bending, {rings} x {sectors}: angle of the first failure, mrad");
    Case::new(what, 1e3 * found, 1e3 * wanted, BEYOND * 1e-6 / RAMP_S)
}

/// A joint of two rings of eight elements that is pressed and twisted until the outer ring has
/// failed and slides on, while the inner one holds: the torque, the work of friction, and what the
/// failure released.
fn twisted(pressure_pa: f64, friction: f64) -> Vec<Case> {
    const COHESION_PA: f64 = 1e5;
    let (angle, half) = (1.2e-3, PI / 8.0);
    let keys = format!(
        ", joint_friction = {friction}, failure = {{ cohesion = {COHESION_PA:e}, friction_angle = 0 }}"
    );
    // Pressed in the first half of the ramp, twisted in the second.
    let more = format!(
        "supports.left = {{ group = \"left\", fixed = true }}
         supports.right = {{ group = \"right\", fixed = [\"y\", \"z\", \"ry\", \"rz\"], displacement = {{ rx = {angle:e} }}, table = [[0, 0], [{:e}, 0], [{RAMP_S}, 1]] }}
         loads.right = {{ group = \"right\", force = [{:e}, 0, 0], ramp = {:e} }}\n",
        0.5 * RAMP_S,
        -pressure_pa * PI * RADIUS_M * RADIUS_M,
        0.4 * RAMP_S
    );
    let keys = keys + ", damping = { normal_damping_ratio = 1 }";
    let mut state = pair(2, 8, &keys, &more);
    until(&mut state, |state| state.time_s > RAMP_S - 1.5e-6);
    let failed = state.bonds.histories.joints[0].failed_fraction();
    assert!((failed - 0.75).abs() < 1e-12, "{failed}");
    let area_m2 = PI * RADIUS_M * RADIUS_M;
    let shear_pa_m = YOUNG_PA / LENGTH_M / (2.0 * (1.0 + POISSON));
    let centroid_m = |inner: f64, outer: f64| {
        2.0 / 3.0 * (outer.powi(3) - inner.powi(3)) / (outer.powi(2) - inner.powi(2)) * half.sin()
            / half
            * RADIUS_M
    };
    let (inside_m, outside_m) = (centroid_m(0.0, 0.5), centroid_m(0.5, 1.0));
    let turned = angle * (state.time_s - 0.5 * RAMP_S) / (0.5 * RAMP_S);
    let fails_at = COHESION_PA / (shear_pa_m * outside_m);
    let rubs_pa = friction * pressure_pa;
    let torque_n_m =
        area_m2 * (0.25 * inside_m * inside_m * shear_pa_m * turned + 0.75 * outside_m * rubs_pa);
    let load = state.bonds.forces(0, &state.particles.poses).load;
    let now = balance(&mut state);
    // The faces slide at once by what the stress falls.
    let falls_pa = COHESION_PA - rubs_pa;
    let slid_m = outside_m * (turned - fails_at) + falls_pa / shear_pa_m;
    let rubbed_j = 0.75 * area_m2 * rubs_pa * slid_m;
    let released_j = 0.75 * area_m2 / (2.0 * shear_pa_m) * falls_pa.powi(2);
    let what = |what: &str| {
        format!(
            "torsion, {} kPa, friction {friction}: {what}",
            1e-3 * pressure_pa
        )
    };
    // The element fails up to a step of the angle late.
    let late = 2.0 * 1e-6 / RAMP_S * angle / fails_at;
    vec![
        Case::new(
            what("torque, N mm"),
            1e3 * load.torsion_n_m,
            1e3 * torque_n_m,
            1e-4,
        ),
        Case::new(
            what("friction, uJ"),
            1e6 * now.friction_j,
            1e6 * rubbed_j,
            3.0 * late,
        ),
        Case::new(
            what("released, uJ"),
            1e6 * now.bond_breakage_j,
            1e6 * released_j,
            3.0 * late,
        ),
    ]
}

fn by_failure() -> String {
    let mut cases: Vec<Case> = pulled(1e5).into();
    cases.extend([bent(1e5, 4, 16), bent(1e5, 3, 12), bent(1e5, 8, 32)]);
    cases.extend(twisted(5e4, 0.4));
    cases.extend(twisted(2e4, 0.8));
    compared("load", "", &cases)
}

#[test]
fn flat_joint() {
    let page = on_one_thread(|| {
        let [bending, torsion] = by_elements();
        filled(
            include_str!("flat-joint.md"),
            &[
                ("bending", bending),
                ("torsion", torsion),
                ("opening", by_opening()),
                ("failure", by_failure()),
            ],
        )
    });
    assert_shown(&[("flat-joint.md".to_owned(), page)]);
}
