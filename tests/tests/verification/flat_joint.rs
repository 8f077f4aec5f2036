//! Flat joints: stiffness of their elements, and a joint that opens under pressure.

use std::f64::consts::PI;

use dem_run::{State, step};

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
            ],
        )
    });
    assert_shown(&[("flat-joint.md".to_owned(), page)]);
}
