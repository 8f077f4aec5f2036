//! Free rotation compared with closed-form solutions.

use super::{reference, unit};
use dem_physics::rotation::{drift, kinetic_j, spin_rad_s};
use dem_testing::Random;
use nalgebra::Vector3;
use serde_json::Value;

fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    std::array::from_fn(|k| value[k].as_f64().unwrap())
}

fn body_spin(q: &[f64; 4], l: [f64; 3], moments: [f64; 3]) -> Vector3<f64> {
    unit(*q).inverse() * Vector3::from(spin_rad_s(q, l, moments))
}

/// The largest errors of the spin, relative to 5 rad/s, and of the quaternion up to a time, for a
/// number of steps per period.
fn errors(steps_per_period: usize, parts: usize) -> (f64, f64) {
    let all = reference();
    let case = &all["dzhanibekov_I_1_2_3"];
    let moments = numbers::<3>(&case["I_principal"]);
    let l = numbers::<3>(&case["L_world"]);
    let period = case["period_of_omega"].as_f64().unwrap();
    let mut q = [0.0, 0.0, 0.0, 1.0];
    let energy = kinetic_j(&q, l, moments);
    assert!((energy / case["E"].as_f64().unwrap() - 1.0).abs() < 1e-15);
    let dt = period / steps_per_period as f64;
    let (mut spin, mut turn) = (0.0_f64, 0.0_f64);
    for part in 1..=parts {
        for _ in 0..steps_per_period / 8 {
            drift(&mut q, l, moments, dt);
        }
        let wanted = Vector3::from(numbers::<3>(&case["omega_body"][part]));
        spin = spin.max((body_spin(&q, l, moments) - wanted).amax() / 5.0);
        let [w, x, y, z] = numbers::<4>(&case["q_wxyz_body_to_world"][part]);
        turn = turn.max(unit(q).angle_to(&unit([x, y, z, w])));
    }
    (spin, turn)
}

#[test]
fn dzhanibekov_matches_the_closed_form() {
    for (steps, parts, bound) in [(20_000, 8, 5e-7), (20_000, 16, 1e-6), (80_000, 16, 1e-7)] {
        let (spin, turn) = errors(steps, parts);
        println!("{steps} steps a period, {parts} eighths: spin {spin:e}, turn {turn:e}");
        assert!(spin < bound && turn < 1.5 * bound, "{spin:e} {turn:e}");
    }
    let all = reference();
    let case = &all["dzhanibekov_I_1_2_3"];
    let (period, l) = (&case["period_of_omega"], numbers::<3>(&case["L_world"]));
    let mut q = [0.0, 0.0, 0.0, 1.0];
    let start = kinetic_j(&q, l, [1.0, 2.0, 3.0]);
    for _ in 0..20_000 {
        drift(
            &mut q,
            l,
            [1.0, 2.0, 3.0],
            period.as_f64().unwrap() / 20_000.0,
        );
        assert!((kinetic_j(&q, l, [1.0, 2.0, 3.0]) / start - 1.0).abs() < 1e-8);
        // The angular momentum computed back from the spin.
        let spin = body_spin(&q, l, [1.0, 2.0, 3.0]);
        let back = unit(q) * spin.component_mul(&Vector3::new(1.0, 2.0, 3.0));
        assert!((back - Vector3::from(l)).norm() < 1e-13);
    }
}

#[test]
fn error_falls_with_the_square_of_the_step() {
    let all = [2000, 4000, 8000].map(|steps| errors(steps, 3));
    for (a, b) in [(all[0], all[1]), (all[1], all[2])] {
        let orders = [(a.0 / b.0).log2(), (a.1 / b.1).log2()];
        println!("orders {orders:?}");
        assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.1), "{orders:?}");
    }
}

#[test]
fn energy_error_is_as_small_as_in_the_comparison() {
    let all = reference();
    let case = &all["dzhanibekov_I_1_2_3"];
    let l = numbers::<3>(&case["L_world"]);
    let period = case["period_of_omega"].as_f64().unwrap();
    for (steps, key) in [(4000, "4000"), (20_000, "20000")] {
        let theirs = &all["integrator_comparison_10_periods"][key]["symplectic_split"]["max_dE"];
        let dt = 10.0 * period / f64::from(steps);
        let mut q = [0.0, 0.0, 0.0, 1.0];
        let start = kinetic_j(&q, l, [1.0, 2.0, 3.0]);
        let mut worst = 0.0_f64;
        for _ in 0..steps {
            drift(&mut q, l, [1.0, 2.0, 3.0], dt);
            worst = worst.max((kinetic_j(&q, l, [1.0, 2.0, 3.0]) / start - 1.0).abs());
        }
        println!("{steps} steps in 10 periods: energy {worst:e}, there {theirs}");
        assert!(worst < 0.1 * theirs.as_f64().unwrap());
    }
}

#[test]
fn symmetric_top_precesses_at_the_known_rates() {
    let all = reference();
    let value = |name: &str| all["symmetric_top"][name].as_f64().unwrap();
    let (axial, across) = (value("I_axial"), value("I_trans"));
    let (spin, side) = (value("omega_axial"), value("omega_trans"));
    for (moments, axis) in [
        ([axial, across, across], 0),
        ([across, axial, across], 1),
        ([across, across, axial], 2),
    ] {
        let other = (axis + 1) % 3;
        let mut l = [0.0; 3];
        l[axis] = axial * spin;
        l[other] = across * side;
        let mut q = [0.0, 0.0, 0.0, 1.0];
        let (dt, steps) = (1e-4, 20_000);
        let mut worst = 0.0_f64;
        let about = Vector3::from(l).normalize();
        let mut figure = Vector3::zeros();
        figure[axis] = 1.0;
        for step in 1..=steps {
            drift(&mut q, l, moments, dt);
            let t = dt * f64::from(step);
            let omega = body_spin(&q, l, moments);
            let angle = value("body_precession_rate") * t;
            let third = (axis + 2) % 3;
            worst = worst
                .max((omega[axis] - spin).abs())
                .max((omega[other] - side * angle.cos()).abs())
                .max((omega[third] - side * angle.sin()).abs());
            let turn = nalgebra::UnitQuaternion::from_scaled_axis(
                about * (value("space_precession_rate") * t),
            );
            worst = worst.max((unit(q) * figure - turn * figure).norm());
        }
        println!("symmetric top, axis {axis}: {worst:e}");
        assert!(worst < 1e-12, "{worst:e}");
    }
}

#[test]
fn going_back_leads_to_the_start() {
    let mut random = Random(11);
    let mut worst = 0.0_f64;
    for _ in 0..20 {
        let start: [f64; 4] = random.rotation().coords.into();
        let (l, moments) = (random.point(3.0), [1.0, 1.7, 2.4]);
        let mut q = start;
        for dt in [0.05, -0.05] {
            for _ in 0..1000 {
                drift(&mut q, l, moments, dt);
            }
        }
        worst = worst.max((0..4).map(|k| (q[k] - start[k]).abs()).fold(0.0, f64::max));
    }
    println!("back after 1000 steps: {worst:e}");
    assert!(worst < 1e-11);
}

#[test]
fn energy_stays_over_a_hundred_thousand_steps() {
    let all = [
        ([1.0, 2.0, 3.0], [0.8, 1.9, 1.1]),
        ([1.0, 1.1, 1.2], [0.3, -0.9, 0.5]),
        ([1.0, 5.0, 5.5], [1.2, 4.0, -2.0]),
        ([1.0, 20.0, 20.2], [2.0, 5.0, 3.0]),
    ];
    for (moments, l0) in all {
        let moments: [f64; 3] = moments;
        let fastest = Vector3::from(l0).norm() / moments[0];
        for part in [50.0, 500.0] {
            let dt = std::f64::consts::TAU / fastest / part;
            let mut q = [0.1, -0.3, 0.5, 0.0];
            q[3] = (1.0_f64 - 0.35).sqrt();
            let l: [f64; 3] = (unit(q) * Vector3::from(l0)).into();
            let start = kinetic_j(&q, l, moments);
            let (mut worst, mut early) = (0.0_f64, 0.0_f64);
            for step in 0..100_000 {
                drift(&mut q, l, moments, dt);
                worst = worst.max((kinetic_j(&q, l, moments) / start - 1.0).abs());
                if step == 5000 {
                    early = worst;
                }
            }
            let norm = q.iter().map(|c| c * c).sum::<f64>() - 1.0;
            println!("{moments:?} 1/{part}: energy {worst:e} ({early:e}), norm {norm:e}");
            assert!(norm.abs() < 1e-15 && worst < 1e-5 && worst < 1.2 * early);
        }
    }
}

#[test]
fn energy_is_right_to_a_hundred_thousandth_for_any_body() {
    let mut random = Random(12);
    let mut most = 0.0_f64;
    for _ in 0..2000 {
        // Any body has moments that are sums of two of three parts.
        let [a, b, c] = [0; 3].map(|_| random.within(0.01, 1.0).powi(2));
        let moments = [b + c, a + c, a + b];
        let l: [f64; 3] = random.direction().into();
        let dt = std::f64::consts::TAU * moments.iter().copied().fold(9.0, f64::min) / 50.0;
        let mut q: [f64; 4] = random.rotation().coords.into();
        let start = kinetic_j(&q, l, moments);
        for _ in 0..1000 {
            drift(&mut q, l, moments, dt);
            most = most.max((kinetic_j(&q, l, moments) / start - 1.0).abs());
        }
    }
    println!("any body, 1/50: energy {most:e}");
    assert!(most < 1e-5);
}

#[test]
fn order_of_the_axes_does_not_matter() {
    // The same body with its axes in reverse order.
    let l = [0.4, -1.1, 2.0];
    let third = 1.0 / 3.0_f64.sqrt();
    let cycle = nalgebra::UnitQuaternion::from_scaled_axis(
        Vector3::repeat(third) * (std::f64::consts::TAU / 3.0),
    );
    let (mut a, mut b) = ([0.0, 0.0, 0.0, 1.0], cycle.coords.into());
    for _ in 0..1000 {
        drift(&mut a, l, [1.0, 2.0, 3.0], 0.01);
        drift(&mut b, l, [2.0, 3.0, 1.0], 0.01);
    }
    assert!((unit(a) * cycle).angle_to(&unit(b)) < 1e-12);
}

#[test]
fn a_million_steps_neither_stretch_the_quaternion_nor_feed_the_rotation() {
    let (l, moments) = ([0.4, -1.1, 2.0], [1.0, 2.0, 3.0]);
    let mut q = [0.0, 0.0, 0.0, 1.0];
    let start = kinetic_j(&q, l, moments);
    let mut largest = 0.0_f64;
    for step in 1..=1_000_000 {
        drift(&mut q, l, moments, 0.01);
        if step % 1000 == 0 {
            largest = largest.max((kinetic_j(&q, l, moments) / start - 1.0).abs());
        }
    }
    let length = q.iter().map(|part| part * part).sum::<f64>().sqrt();
    assert!((length - 1.0).abs() < 1e-12, "{length}");
    // The error of a step of second order: 0.01 times 0.8 rad/s, squared.
    assert!(largest < 0.008_f64.powi(2), "{largest:e}");
}
