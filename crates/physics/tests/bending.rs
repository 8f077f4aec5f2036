//! Bending of slender rigid bodies against statics of beams: a row of spheres whose bonds, of radius
//! r, have a section modulus of pi r^3 / 4.

use std::f64::consts::PI;

use dem_physics::bending::{Beyond, Bond, Part, SlenderBody};
use nalgebra::Vector3;

const APART_M: f64 = 0.009;
const RADIUS_M: f64 = 0.005;
const MASS_KG: f64 = 1.3e-3;
const INERTIA_KG_M2: f64 = 0.4 * MASS_KG * RADIUS_M * RADIUS_M;
const MODULUS_PA: f64 = 1e9;

/// A row of this many spheres along x, with its principal moments of inertia.
fn row(count: usize) -> (Vec<Part>, [f64; 3], Vec<Bond>) {
    let place = |k: usize| Vector3::x() * APART_M * (k as f64 - 0.5 * (count as f64 - 1.0));
    let part = |k: usize| Part {
        place_m: place(k),
        radius_m: RADIUS_M,
        mass_kg: MASS_KG,
        inertia_kg_m2: INERTIA_KG_M2,
    };
    let bond = |k: usize| Bond {
        ends_m: [place(k), place(k + 1)],
        radius_m: RADIUS_M,
        axial_stiffness_n: MODULUS_PA * PI * RADIUS_M * RADIUS_M,
    };
    let own = count as f64 * INERTIA_KG_M2;
    let across: f64 = (0..count).map(|k| MASS_KG * place(k).x.powi(2)).sum();
    let parts = (0..count).map(part).collect();
    let bonds = (0..count - 1).map(bond).collect();
    (parts, [own, own + across, own + across], bonds)
}

/// Largest stress in a row under a force at a place, Pa, and the rate at which modes follow it.
fn stress(count: usize, force: Vector3<f64>, at_m: Vector3<f64>) -> [f64; 2] {
    let (parts, moments, bonds) = row(count);
    let body = SlenderBody::of(&parts, (parts.len() as f64 * MASS_KG, moments), &bonds).unwrap();
    let torque = at_m.cross(&force);
    let turning = torque.component_div(&Vector3::from(moments));
    let linear = force / (count as f64 * MASS_KG);
    let mut beyond = Beyond::default();
    body.add(&mut beyond, &at_m, [force, torque]);
    body.stress([linear, turning], &beyond)
}

/// Stress at the edge of a round bar under a moment, Pa.
fn of_round_bar_pa(moment_n_m: f64) -> f64 {
    moment_n_m / (PI * RADIUS_M.powi(3) / 4.0)
}

#[test]
fn a_free_row_bends_as_a_free_bar_under_a_force_anywhere() {
    let force_n = 7.0;
    for count in [20, 40, 200] {
        let length_m = count as f64 * APART_M;
        let product = force_n * length_m;
        // Largest moments of a uniform free bar in the sections at a quarter, the middle and three
        // quarters, for a force at its middle, at an end and at a quarter.
        for (at, expected_n_m) in [
            (0.0, product / 8.0),
            (-0.5, 9.0 / 64.0 * product),
            (-0.25, 9.0 / 128.0 * product),
        ] {
            let place = Vector3::new(at * length_m, 0.0, -RADIUS_M);
            for across in [Vector3::z(), Vector3::y(), Vector3::new(0.0, 0.6, -0.8)] {
                let [stress_pa, _] = stress(count, force_n * across, place);
                let ratio = stress_pa / of_round_bar_pa(expected_n_m);
                // The spheres have their mass in their centres, and moments of their own.
                assert!(
                    (ratio - 1.0).abs() < 3.0 / count as f64,
                    "{count} {at}: {ratio}"
                );
            }
        }
        // A push along the row, through its middle, bends nothing; torsion is no bending.
        let end = -0.5 * length_m * Vector3::x();
        let [pushed_pa, _] = stress(count, force_n * Vector3::x(), end);
        assert!(pushed_pa < 1e-9 * of_round_bar_pa(product));
    }
}

/// Shape of the mode of a free beam with this root of cos(x) cosh(x) = 1, of unit mean square, and
/// its second derivative over (root / length)^2, at a fraction of the length.
fn mode(root: f64, at: f64) -> [f64; 2] {
    let ratio = (root.cosh() - root.cos()) / (root.sinh() - root.sin());
    let (x, y) = (root * at, ratio);
    [
        x.cosh() + x.cos() - y * (x.sinh() + x.sin()),
        x.cosh() - x.cos() - y * (x.sinh() - x.sin()),
    ]
}

#[test]
fn modes_follow_a_stress_as_those_of_a_free_bar() {
    let count = 200;
    let (length_m, inertia_m4) = (count as f64 * APART_M, PI * RADIUS_M.powi(4) / 4.0);
    let per_length = MASS_KG / APART_M;
    let bar_1_s = (MODULUS_PA * inertia_m4 / per_length).sqrt() / length_m.powi(2);
    // An impulse J moves a mode of shape s by J s / (mass, frequency), whose moment is E I s''.
    let roots = [4.730_040_744_862_7, 7.853_204_624_095_8];
    for (at, rigid) in [(0.5, 1.0 / 8.0), (0.25, 9.0 / 128.0)] {
        let modes = roots.map(|root| {
            let [shape, second] = mode(root, at);
            (shape * second).abs()
        });
        let expected = modes.iter().sum::<f64>() / rigid * bar_1_s;
        let place = Vector3::new((at - 0.5) * length_m, 0.0, -RADIUS_M);
        let [stress_pa, rate_pa_s] = stress(count, Vector3::z(), place);
        let ratio = rate_pa_s / stress_pa / expected;
        assert!((ratio - 1.0).abs() < 0.02, "{at}: {ratio}");
    }
}

#[test]
fn only_slender_bodies_have_sections() {
    let is_slender = |count| {
        let (parts, moments, bonds) = row(count);
        SlenderBody::of(&parts, (parts.len() as f64 * MASS_KG, moments), &bonds).is_some()
    };
    assert!(!is_slender(3));
    assert!(!is_slender(4));
    assert!(is_slender(6));
    let (parts, moments, mut bonds) = row(30);
    bonds.remove(14);
    assert!(SlenderBody::of(&parts, (parts.len() as f64 * MASS_KG, moments), &bonds).is_none());
}

/// A body whose mass and moments are not the sums of its parts, as those of a union of spheres are,
/// bends alike under mirrored forces, and only by what it weighs.
#[test]
fn masses_of_parts_are_scaled_to_those_of_the_body() {
    let (parts, moments, bonds) = row(30);
    let of = |scale: f64, end: f64| {
        let mass_kg = scale * 30.0 * MASS_KG;
        let moments = moments.map(|moment| 0.9 * scale * moment);
        let body = SlenderBody::of(&parts, (mass_kg, moments), &bonds).unwrap();
        let at_m = Vector3::new(end * 14.5 * APART_M, 0.0, -RADIUS_M);
        let torque = at_m.cross(&Vector3::z());
        let mut beyond = Beyond::default();
        body.add(&mut beyond, &at_m, [Vector3::z(), torque]);
        let turning = torque.component_div(&Vector3::from(moments));
        body.stress([Vector3::z() / mass_kg, turning], &beyond)[0]
    };
    for scale in [1.0, 0.7] {
        let [left, right] = [-1.0, 1.0].map(|end| of(scale, end));
        assert!((left / right - 1.0).abs() < 1e-9, "{left} {right}");
        assert!((left / of(1.0, -1.0) - 1.0).abs() < 1e-9);
    }
}
