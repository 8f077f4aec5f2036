//! Mass properties compared with published values, closed forms and samples.

use std::f64::consts::PI;
use std::time::Instant;

use super::{reference, turned, unit};
use dem_physics::shape::inertia::{MassProperties, of_spheres, of_union};
use dem_testing::Random;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

fn tensor(p: &MassProperties) -> Matrix3<f64> {
    let r = unit(p.axes).to_rotation_matrix();
    r.matrix() * Matrix3::from_diagonal(&p.moments_kg_m2.into()) * r.matrix().transpose()
}

/// The largest relative difference of two bodies, the second rotated by `q` and moved by `by`.
fn apart(a: &MassProperties, b: &MassProperties, q: &UnitQuaternion<f64>, by: [f64; 3]) -> f64 {
    let r = q.to_rotation_matrix();
    let inertia = r.matrix() * tensor(a) * r.matrix().transpose();
    let size = (a.moments_kg_m2[2] / a.mass_kg).sqrt();
    let centre = q * Vector3::from(a.centre_m) + Vector3::from(by);
    [
        (a.mass_kg / b.mass_kg - 1.0).abs(),
        (centre - Vector3::from(b.centre_m)).norm() / size,
        (inertia - tensor(b)).amax() / inertia.amax(),
    ]
    .into_iter()
    .fold(0.0, f64::max)
}

fn close(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a} is not {b}");
}

#[test]
fn collinear_unions_match_the_reference() {
    let all = reference();
    let mut random = Random(1);
    for (key, x, r) in [
        ("two_equal_R1_d1.2", vec![0.0, 1.2], vec![1.0, 1.0]),
        ("three_collinear", vec![0.0, 1.2, 2.0], vec![1.0, 0.8, 0.5]),
    ] {
        let value = |name: &str| all[key][name].as_f64().unwrap();
        let mut worst = 0.0_f64;
        for turn in 0..20 {
            let q = if turn == 0 {
                UnitQuaternion::identity()
            } else {
                random.rotation()
            };
            let line: Vec<[f64; 3]> = x.iter().map(|&x| [x, 0.0, 0.0]).collect();
            let body = of_union(&turned(&q, &line), &r, 1.0);
            close(body.mass_kg, value("volume"), 1e-12);
            let centre = q.inverse() * Vector3::from(body.centre_m);
            assert!((centre - Vector3::x() * value("xc")).norm() < 1e-12);
            close(body.moments_kg_m2[0], value("I_axial"), 1e-12);
            close(body.moments_kg_m2[1], value("I_trans"), 1e-12);
            close(body.moments_kg_m2[2], value("I_trans"), 1e-12);
            let long = unit(body.axes) * Vector3::x();
            assert!(long.cross(&(q * Vector3::x())).norm() < 1e-12);
            for (name, k) in [("I_axial", 0), ("I_trans", 1), ("I_trans", 2)] {
                worst = worst.max((body.moments_kg_m2[k] / value(name) - 1.0).abs());
            }
            worst = worst.max((body.mass_kg / value("volume") - 1.0).abs());
        }
        println!("{key}: {worst:e}");
    }
    let two = &all["two_equal_R1_d1.2"];
    let mass = 4.0 / 3.0 * PI;
    let sum = of_spheres(&[[0.0; 3], [1.2, 0.0, 0.0]], &[mass; 2], &[0.4 * mass; 2]);
    close(
        sum.mass_kg,
        two["sum_of_spheres_volume"].as_f64().unwrap(),
        1e-13,
    );
    close(
        sum.moments_kg_m2[0],
        two["naive_sum_I_axial"].as_f64().unwrap(),
        1e-13,
    );
    close(
        sum.moments_kg_m2[2],
        two["naive_sum_I_trans"].as_f64().unwrap(),
        1e-13,
    );
}

/// Three spheres with a common overlap. The reference values are integrals of the height of the
/// union over the plane of the centres, over the three sectors of its power diagram, to 30 digits.
#[test]
fn three_spheres_match_integrals_with_thirty_digits() {
    let centres = [[0.0, 0.0, 0.0], [1.1, 0.0, 0.0], [0.4, 0.8, 0.0]];
    let radii = [1.0, 0.9, 0.7];
    let v = 7.080_601_918_792_524;
    let (mx, my) = (3.156_163_398_919_717_6, 0.701_911_665_179_102_5);
    let (xx, yy) = (4.888_052_516_833_269, 2.021_604_993_459_246);
    let (xy, zz) = (0.307_801_328_767_644_24, 1.324_373_557_432_136_6);
    let (cx, cy) = (mx / v, my / v);
    let (xx, yy, xy) = (xx - mx * cx, yy - my * cy, xy - mx * cy);
    let wanted = Matrix3::new(yy + zz, -xy, 0.0, -xy, xx + zz, 0.0, 0.0, 0.0, xx + yy);
    let mut random = Random(2);
    let mut worst = 0.0_f64;
    for _ in 0..50 {
        let q = random.rotation();
        let body = of_union(&turned(&q, &centres), &radii, 2.0);
        let r = q.to_rotation_matrix();
        let inertia = r.matrix().transpose() * tensor(&body) * r.matrix() / 2.0;
        let centre = q.inverse() * Vector3::from(body.centre_m);
        worst = worst
            .max((body.mass_kg / 2.0 / v - 1.0).abs())
            .max((centre - Vector3::new(cx, cy, 0.0)).norm())
            .max((inertia - wanted).amax() / wanted.amax());
    }
    println!("three spheres: {worst:e}");
    assert!(worst < 1e-13, "{worst:e}");
}

fn cluster(random: &mut Random, count: usize, half: f64) -> (Vec<[f64; 3]>, Vec<f64>) {
    let centres = (0..count).map(|_| random.point(half)).collect();
    (
        centres,
        (0..count).map(|_| random.within(0.3, 1.0)).collect(),
    )
}

fn lattice(side: i32, step: f64) -> Vec<[f64; 3]> {
    let mut points = Vec::new();
    for x in 0..side {
        for y in 0..side {
            points.extend((0..side).map(|z| [x, y, z].map(|c| f64::from(c) * step)));
        }
    }
    points
}

#[test]
fn unions_match_samples() {
    let mut random = Random(3);
    for count in [2, 5, 30] {
        let (centres, radii) = cluster(&mut random, count, 1.2);
        let body = of_union(&centres, &radii, 1.0);
        let (mut hits, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        let tries = 1_000_000;
        for _ in 0..tries {
            let p = Vector3::from(random.point(2.2));
            let inside = |(c, r): (&[f64; 3], &f64)| (p - Vector3::from(*c)).norm_squared() < r * r;
            if centres.iter().zip(&radii).any(inside) {
                hits += 1.0;
                first += p;
                second += p * p.transpose();
            }
        }
        let cell = 4.4_f64.powi(3) / f64::from(tries);
        close(hits * cell, body.mass_kg, 0.01);
        let centre: Vector3<f64> = first / hits;
        assert!((centre - Vector3::from(body.centre_m)).norm() < 0.01);
        let second = (second - centre * first.transpose()) * cell;
        let inertia = Matrix3::from_diagonal_element(second.trace()) - second;
        assert!((inertia - tensor(&body)).amax() < 0.02 * inertia.amax());
    }
}

#[test]
fn unions_do_not_depend_on_place_turn_or_order() {
    let mut random = Random(4);
    let mut bodies: Vec<_> = [(40, 1.5), (300, 3.0), (300, 6.0)]
        .map(|(count, half)| cluster(&mut random, count, half))
        .into();
    // Many circles through one point, circles that only touch, and equal spheres.
    for step in [1.0, 2.0_f64.sqrt(), 2.0, 2.0 / 3.0_f64.sqrt()] {
        let points = lattice(4, step);
        bodies.push((points.clone(), vec![1.0; points.len()]));
        bodies.push(([points.clone(), points].concat(), vec![1.0; 128]));
    }
    for (centres, radii) in &bodies {
        let body = of_union(centres, radii, 1.0);
        let mut worst = 0.0_f64;
        for _ in 0..5 {
            let q = random.rotation();
            let mut moved = turned(&q, centres);
            for p in &mut moved {
                *p = [p[0] + 3.0, p[1] - 1.0, p[2] + 0.25];
            }
            moved.reverse();
            let radii: Vec<f64> = radii.iter().rev().copied().collect();
            let other = of_union(&moved, &radii, 1.0);
            worst = worst.max(apart(&body, &other, &q, [3.0, -1.0, 0.25]));
        }
        println!("{} spheres turned: {worst:e}", centres.len());
        assert!(worst < 1e-12, "{} spheres: {worst:e}", centres.len());
    }
}

#[test]
fn spheres_that_touch_barely_or_nearly_coincide_are_right() {
    let ball = 4.0 / 3.0 * PI;
    for gap in [-1e-15, 1e-15, 1e-12, 1e-9, 1e-6] {
        // Overlap of two unit spheres.
        let d: f64 = 2.0 - gap;
        let lens = if gap > 0.0 {
            PI * (4.0 + d) * gap * gap / 12.0
        } else {
            0.0
        };
        let body = of_union(&[[0.0; 3], [0.6 * d, 0.0, 0.8 * d]], &[1.0; 2], 1.0);
        close(body.mass_kg, 2.0 * ball - lens, 1e-14);
    }
    for d in [1e-300, 1e-17, 1e-15, 1e-12, 1e-8, 1e-4] {
        let d: f64 = d;
        let lens = PI * (4.0 + d) * (2.0 - d) * (2.0 - d) / 12.0;
        let body = of_union(&[[0.0; 3], [0.6 * d, 0.0, 0.8 * d]], &[1.0; 2], 1.0);
        close(body.mass_kg, 2.0 * ball - lens, 1e-14);
        // Three near one point, with a fourth transverse to them.
        let four = [
            [0.0; 3],
            [d, 0.0, 0.0],
            [0.0, 0.7 * d, 0.3 * d],
            [0.5, 0.3, 0.2],
        ];
        let body = of_union(&four, &[1.0; 4], 1.0);
        let pair = of_union(&[four[0], four[3]], &[1.0; 2], 1.0);
        assert!((body.mass_kg - pair.mass_kg).abs() < 8.0 * d + 1e-13);
        let q = Random(9).rotation();
        let other = of_union(&turned(&q, &four), &[1.0; 4], 1.0);
        assert!(apart(&body, &other, &q, [0.0; 3]) < 1e-13);
    }
    // A set of spheres through one circle.
    let pencil: Vec<[f64; 3]> = (-5..=5).map(|k| [0.1 * f64::from(k), 0.0, 0.0]).collect();
    let radii: Vec<f64> = pencil.iter().map(|c| (1.0 + c[0] * c[0]).sqrt()).collect();
    let ends = of_union(&[pencil[0], pencil[10]], &[radii[0], radii[10]], 1.0);
    let q = UnitQuaternion::identity();
    assert!(apart(&ends, &of_union(&pencil, &radii, 1.0), &q, [0.0; 3]) < 1e-13);
    let q = Random(5).rotation();
    let other = of_union(&turned(&q, &pencil), &radii, 1.0);
    assert!(apart(&ends, &other, &q, [0.0; 3]) < 1e-13);
}

#[test]
fn hidden_equal_and_separate_spheres_add_nothing_or_all() {
    let one = of_union(&[[1.0, 2.0, 3.0]], &[0.5], 1000.0);
    close(one.mass_kg, 1000.0 * PI / 6.0, 1e-14);
    assert_eq!(one.centre_m, [1.0, 2.0, 3.0]);
    assert_eq!(one.axes, [0.0, 0.0, 0.0, 1.0]);
    for moment in one.moments_kg_m2 {
        close(moment, 0.1 * one.mass_kg, 1e-14);
    }
    let three = of_union(
        &[[1.0, 2.0, 3.0], [1.1, 2.0, 3.0], [1.0, 2.0, 3.0]],
        &[0.5, 0.2, 0.5],
        1000.0,
    );
    let q = UnitQuaternion::identity();
    assert!(apart(&one, &three, &q, [0.0; 3]) < 1e-14);

    let centres = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 1.0], [1.0, -3.0, 5.0]];
    let radii = [1.0, 0.5, 0.7, 1.5];
    let masses = radii.map(|r: f64| 4.0 / 3.0 * PI * r.powi(3));
    let own: Vec<f64> = radii
        .iter()
        .zip(masses)
        .map(|(r, m)| 0.4 * m * r * r)
        .collect();
    let union = of_union(&centres, &radii, 1.0);
    assert!(apart(&union, &of_spheres(&centres, &masses, &own), &q, [0.0; 3]) < 1e-14);
}

#[test]
fn sums_hold_far_from_the_origin() {
    let mut random = Random(6);
    // On a grid that is represented exactly after a shift by 2^20.
    let centres: Vec<[f64; 3]> = (0..10_000)
        .map(|_| {
            random
                .point(1.0)
                .map(|c| (c * 2.0_f64.powi(30)).round() / 2.0_f64.powi(30))
        })
        .collect();
    let masses: Vec<f64> = centres.iter().map(|_| random.within(0.1, 2.0)).collect();
    let own: Vec<f64> = masses.iter().map(|m| 1e-4 * m).collect();
    let near = of_spheres(&centres, &masses, &own);
    let shift = 2.0_f64.powi(20);
    let far: Vec<[f64; 3]> = centres.iter().map(|c| c.map(|x| x + shift)).collect();
    let far = of_spheres(&far, &masses, &own);
    for k in 0..3 {
        close(far.moments_kg_m2[k], near.moments_kg_m2[k], 1e-14);
        close(far.centre_m[k], near.centre_m[k] + shift, 1e-15);
    }
    assert!(unit(far.axes).angle_to(&unit(near.axes)) < 1e-13);
    // A dumbbell in closed form.
    let d = of_spheres(
        &[[1e6, 0.0, 0.0], [1e6, 4.0, 0.0]],
        &[1.0, 3.0],
        &[0.25, 0.5],
    );
    assert_eq!(d.centre_m, [1e6, 3.0, 0.0]);
    assert_eq!(d.moments_kg_m2, [0.75, 12.75, 12.75]);
}

#[test]
fn axes_are_right_handed_and_rise() {
    let mut random = Random(7);
    for _ in 0..200 {
        let (centres, radii) = cluster(&mut random, 6, 1.0);
        let body = of_union(&centres, &radii, 1.0);
        let [a, b, c] = body.moments_kg_m2;
        assert!(a <= b && b <= c && body.axes[3] >= 0.0);
        assert!((unit(body.axes).norm() - 1.0).abs() < 1e-15);
    }
    let empty = of_union(&[], &[], 1.0);
    assert_eq!((empty.mass_kg, empty.axes), (0.0, [0.0, 0.0, 0.0, 1.0]));
    assert_eq!(
        of_spheres(&[[1.0; 3]], &[0.0], &[0.0]).moments_kg_m2,
        [0.0; 3]
    );
    assert_eq!(of_union(&[[1.0; 3]], &[0.0], 1.0).mass_kg, 0.0);
    assert!(of_spheres(&[[f64::NAN; 3], [0.0; 3]], &[1.0; 2], &[1.0; 2]).moments_kg_m2[0].is_nan());
    assert!(of_spheres(&[[0.0; 3]], &[1.0], &[f64::INFINITY]).moments_kg_m2[0].is_nan());
    assert!(of_union(&[[f64::NAN; 3], [0.0; 3]], &[1.0; 2], 1.0).mass_kg >= 0.0);
}

#[test]
fn thousands_of_spheres_take_little_time() {
    let mut random = Random(8);
    for (count, half) in [(10_000, 10.0), (3000, 3.0)] {
        let (centres, radii) = cluster(&mut random, count, half);
        let start = Instant::now();
        let body = of_union(&centres, &radii, 1.0);
        println!("union of {count} in {half}: {:?}", start.elapsed());
        let q = random.rotation();
        let other = of_union(&turned(&q, &centres), &radii, 1.0);
        let worst = apart(&body, &other, &q, [0.0; 3]);
        println!("turned: {worst:e}");
        assert!(worst < 1e-12);
    }
}
