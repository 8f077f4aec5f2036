//! The best-fit rotation compared with known ones.

use super::{turned, unit};
use dem_physics::shape::fit::best_rotation;
use dem_testing::Random;
use nalgebra::{UnitQuaternion, Vector3};

fn centred(mut points: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    let mean: Vector3<f64> = points
        .iter()
        .map(|p| Vector3::from(*p))
        .sum::<Vector3<f64>>()
        / points.len() as f64;
    for p in &mut points {
        *p = (Vector3::from(*p) - mean).into();
    }
    points
}

/// The largest remaining distance, and the largest distance from the centre.
fn left(q: [f64; 4], from: &[[f64; 3]], to: &[[f64; 3]]) -> (f64, f64) {
    let far = |p: &[f64; 3]| Vector3::from(*p).norm();
    let rest = turned(&unit(q), from);
    let rest = rest
        .iter()
        .zip(to)
        .map(|(a, b)| (Vector3::from(*a) - Vector3::from(*b)).norm());
    (
        rest.fold(0.0, f64::max),
        from.iter().map(far).fold(0.0, f64::max),
    )
}

fn difference(a: [f64; 4], b: &UnitQuaternion<f64>) -> f64 {
    let sign = 1.0_f64.copysign(b.w);
    (0..4)
        .map(|k| (a[k] - sign * b.coords[k]).abs())
        .fold(0.0, f64::max)
}

#[test]
fn exact_copies_are_found_to_rounding() {
    let mut random = Random(21);
    let mut worst = 0.0_f64;
    for count in [3, 4, 10, 100, 10_000] {
        for stretch in [
            [1.0; 3],
            [1.0, 0.3, 0.01],
            [1.0, 1.0, 0.0],
            [1.0, 1e-3, 1e-4],
        ] {
            for _ in 0..10 {
                let points = (0..count).map(|_| {
                    let p = random.point(1.0);
                    [0, 1, 2].map(|k| p[k] * stretch[k])
                });
                let points = centred(points.collect());
                let points = turned(&random.rotation(), &points);
                let weights: Vec<f64> = points.iter().map(|_| random.within(0.1, 2.0)).collect();
                let q = random.rotation();
                let to = turned(&q, &points);
                let found = best_rotation(&points, &to, &weights);
                let (rest, size) = left(found, &points, &to);
                assert!(rest < 3e-15 * size, "{count} {stretch:?}: {rest:e}");
                if stretch[1] > 0.1 {
                    worst = worst.max(difference(found, &q));
                }
            }
        }
    }
    println!("copies: {worst:e}");
    assert!(worst < 1e-14, "{worst:e}");
}

#[test]
fn half_turns_and_the_identity_are_exact() {
    let mut random = Random(22);
    let points = centred((0..50).map(|_| random.point(1.0)).collect());
    let mut axes: Vec<Vector3<f64>> = (0..20).map(|_| random.direction()).collect();
    axes.extend([Vector3::x(), Vector3::y(), Vector3::z()]);
    for axis in axes {
        for angle in [0.0, 1e-12, 1e-6, 3.0, std::f64::consts::PI] {
            let q = UnitQuaternion::from_scaled_axis(axis * angle);
            let to = turned(&q, &points);
            let found = best_rotation(&points, &to, &[1.0; 50]);
            assert!(left(found, &points, &to).0 < 3e-15);
        }
    }
}

#[test]
fn points_on_a_line_or_near_it_are_carried_over() {
    let mut random = Random(23);
    for width in [0.0, 1e-15, 1e-12, 1e-10, 1e-8, 3e-7, 1e-6, 1e-5, 1e-3] {
        let mut worst = 0.0_f64;
        for _ in 0..50 {
            let points = (-10..=10).map(|k| {
                let [y, z, _] = random.point(width);
                [0.1 * f64::from(k), y, z]
            });
            let points = centred(points.collect());
            let points = turned(&random.rotation(), &points);
            let to = turned(&random.rotation(), &points);
            worst = worst.max(left(best_rotation(&points, &to, &[1.0; 21]), &points, &to).0);
        }
        println!("line of width {width:e}: {worst:e}");
        assert!(worst < 1e-14, "{width:e}: {worst:e}");
    }
    let x = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]];
    let y = [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let quarter = UnitQuaternion::from_scaled_axis(Vector3::z() * std::f64::consts::FRAC_PI_2);
    assert!(difference(best_rotation(&x, &y, &[1.0; 2]), &quarter) < 1e-15);
    let flipped = best_rotation(&x, &[x[1], x[0]], &[1.0; 2]);
    assert!(left(flipped, &x, &[x[1], x[0]]).0 < 1e-15);
    let nan = [[f64::NAN; 3]];
    assert_eq!(best_rotation(&nan, &nan, &[1.0]), [0.0, 0.0, 0.0, 1.0]);
    for none in [
        best_rotation(&[], &[], &[]),
        best_rotation(&[[0.0; 3]], &[[0.0; 3]], &[1.0]),
    ] {
        assert_eq!(none, [0.0, 0.0, 0.0, 1.0]);
    }
}

#[test]
fn noise_gives_the_least_squares() {
    let mut random = Random(24);
    for count in [4, 30, 1000] {
        let points = centred((0..count).map(|_| random.point(1.0)).collect());
        let weights: Vec<f64> = (0..count).map(|_| random.within(0.1, 2.0)).collect();
        let q = random.rotation();
        let noisy = turned(&q, &points).into_iter().map(|p| {
            let n = random.point(0.05);
            [0, 1, 2].map(|k| p[k] + n[k])
        });
        let noisy: Vec<[f64; 3]> = noisy.collect();
        let found = best_rotation(&points, &noisy, &weights);
        let torque = |q: &UnitQuaternion<f64>| {
            let pairs = turned(q, &points).into_iter().zip(&noisy).zip(&weights);
            let sum = pairs.map(|((a, b), &w)| Vector3::from(a).cross(&Vector3::from(*b)) * w);
            sum.sum::<Vector3<f64>>().norm() / f64::from(count)
        };
        assert!(torque(&unit(found)) < 1e-14, "{:e}", torque(&unit(found)));
        assert!(unit(found).angle_to(&q) < 0.1);
    }
}

#[test]
fn mirror_images_give_a_rotation_all_the_same() {
    let mut random = Random(25);
    let points = centred((0..20).map(|_| random.point(1.0)).collect());
    let mirror: Vec<[f64; 3]> = points.iter().map(|p| [p[0], p[1], -p[2]]).collect();
    let found = best_rotation(&points, &mirror, &[1.0; 20]);
    let miss = |q: &UnitQuaternion<f64>| {
        let pairs = turned(q, &points).into_iter().zip(&mirror);
        pairs
            .map(|(a, b)| (Vector3::from(a) - Vector3::from(*b)).norm_squared())
            .sum::<f64>()
    };
    let best = miss(&unit(found));
    assert!((0..5000).all(|_| miss(&random.rotation()) >= best));
}

#[test]
fn ten_swaps_do_not_drift() {
    let mut random = Random(26);
    let shape = centred((0..500).map(|_| random.point(1.0)).collect());
    let q = random.rotation();
    let mut placed = turned(&q, &shape);
    let first = placed.clone();
    for _ in 0..10 {
        placed = turned(&unit(best_rotation(&shape, &placed, &[1.0; 500])), &shape);
    }
    let (drift, _) = left([0.0, 0.0, 0.0, 1.0], &first, &placed);
    println!("ten swaps: {drift:e}");
    assert!(drift < 1e-14);
}
