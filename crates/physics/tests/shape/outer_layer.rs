//! The outer layer of known arrangements, and compared with sampled points.

use std::collections::BTreeSet;
use std::time::Instant;

use super::turned;
use dem_physics::shape::outer_layer::outer_layer;
use dem_testing::Random;
use nalgebra::Vector3;

const NONE: [u32; 0] = [];

#[test]
fn one_two_and_nested_spheres() {
    assert_eq!(outer_layer(&[], &[], 0.0, 0.0), NONE);
    assert_eq!(outer_layer(&[[5.0; 3]], &[2.0], 0.0, 0.0), [0]);
    let at = |x: f64| [x, 0.0, 0.0];
    for gap in [0.0, 0.5, 1.9, 2.0, 2.1, 100.0] {
        for margin in [0.0, 0.05, 0.5] {
            let wanted: Vec<u32> = if gap == 0.0 { vec![0] } else { vec![0, 1] };
            assert_eq!(
                outer_layer(&[at(0.0), at(gap)], &[1.0; 2], margin, 0.0),
                wanted
            );
        }
    }
    // Inside, inside and touching, across the surface, and free only because of the growth.
    assert_eq!(outer_layer(&[at(0.0), at(0.3)], &[1.0, 0.5], 0.0, 0.0), [0]);
    assert_eq!(outer_layer(&[at(0.0), at(0.5)], &[1.0, 0.5], 0.0, 0.0), [0]);
    assert_eq!(
        outer_layer(&[at(0.6), at(0.0)], &[0.5, 1.0], 0.0, 0.0),
        [0, 1]
    );
    assert_eq!(
        outer_layer(&[at(0.49), at(0.0)], &[0.5, 1.0], 0.0, 0.0),
        [1]
    );
    assert_eq!(
        outer_layer(&[at(0.49), at(0.0)], &[0.5, 1.0], 0.05, 0.0),
        [0, 1]
    );
    assert_eq!(outer_layer(&[at(0.3), at(0.3)], &[0.5, 1.0], 0.5, 0.0), [1]);
}

#[test]
fn of_equal_spheres_in_one_place_the_first_counts() {
    let points = [
        [1.0; 3],
        [1.0; 3],
        [1.0; 3],
        [2.0, 1.0, 1.0],
        [2.0, 1.0, 1.0 + 1e-16],
    ];
    for margin in [0.0, 0.1] {
        assert_eq!(outer_layer(&points, &[1.0; 5], margin, 0.0), [0, 3]);
        assert_eq!(
            outer_layer(&points, &[1.0, 1.0, 1.0, 5.0, 5.0], margin, 0.0),
            [3]
        );
    }
}

/// The corners of an icosahedron, and the middles of its edges.
fn shells() -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>) {
    let g = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut twelve = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        for v in [[0.0, a, b], [a, b, 0.0], [b, 0.0, a]] {
            twelve.push(Vector3::from(v).normalize());
        }
    }
    let mut all = twelve.clone();
    for (i, a) in twelve.iter().enumerate() {
        for b in twelve[..i].iter().filter(|b| a.dot(b) > 0.4) {
            all.push((a + b).normalize());
        }
    }
    (twelve, all)
}

#[test]
fn shells_of_12_and_42_hide_the_middle_until_one_is_gone() {
    let (twelve, all) = shells();
    assert_eq!((twelve.len(), all.len()), (12, 42));
    let mut random = Random(31);
    for (shell, radius) in [(twelve, 1.2), (all, 1.05)] {
        for q in [random.rotation(), random.rotation(), random.rotation()] {
            let mut points = vec![[0.0; 3]];
            points.extend(shell.iter().map(|v| <[f64; 3]>::from(v * 1.3)));
            let points = turned(&q, &points);
            let mut radii = vec![radius; points.len()];
            radii[0] = 1.0;
            let wanted: Vec<u32> = (1..points.len() as u32).collect();
            assert_eq!(outer_layer(&points, &radii, 0.0, 0.0), wanted);
            // The middle one again, smaller, so that the hole of a missing one exposes it or not.
            for gone in 1..points.len() {
                let mut fewer = points.clone();
                fewer.remove(gone);
                let is_outer = outer_layer(&fewer, &radii[1..], 0.0, 0.0).contains(&0);
                let shown = (0..200_000)
                    .map(|_| random.direction())
                    .take(if gone < 4 { 200_000 } else { 0 })
                    .any(|v| {
                        let far = |p: &[f64; 3]| (v * radius - Vector3::from(*p)).norm();
                        fewer[1..].iter().all(|p| far(p) > radius)
                    });
                assert!(gone >= 4 || is_outer == shown, "{gone}: {is_outer}");
            }
            let mut fewer = points.clone();
            fewer.remove(7);
            radii.pop();
            assert!(outer_layer(&fewer, &radii, 0.0, 0.0).contains(&0) == (shell.len() == 12));
        }
    }
}

fn lattice(side: i32, step: f64) -> (Vec<[f64; 3]>, Vec<u32>) {
    let (mut points, mut skin) = (Vec::new(), Vec::new());
    for x in 0..side {
        for y in 0..side {
            for z in 0..side {
                if [x, y, z].iter().any(|&c| c == 0 || c == side - 1) {
                    skin.push(points.len() as u32);
                }
                points.push([x, y, z].map(|c| f64::from(c) * step));
            }
        }
    }
    (points, skin)
}

#[test]
fn dense_blocks_have_their_skin() {
    let mut random = Random(32);
    for turn in 0..3 {
        for (step, margin) in [(1.0, 0.0), (1.0, 0.1), (0.7, 0.0), (1.0, 0.15), (1.1, 0.04)] {
            let (points, skin) = lattice(8, step);
            let points = if turn == 0 {
                points
            } else {
                turned(&random.rotation(), &points)
            };
            assert_eq!(
                outer_layer(&points, &vec![1.0; points.len()], margin, 0.0),
                skin
            );
        }
        // Above 2 / sqrt 3, there are voids between eight spheres.
        let (points, _) = lattice(6, 1.16);
        let all: Vec<u32> = (0..216).collect();
        assert_eq!(outer_layer(&points, &[1.0; 216], 0.0, 0.0), all);
        // Exactly there, the last points are single and count as hidden or not; nothing else may
        // change.
        let (points, skin) = lattice(6, 2.0 / 3.0_f64.sqrt());
        let points = turned(&random.rotation(), &points);
        let found: BTreeSet<u32> = outer_layer(&points, &[1.0; 216], 0.0, 0.0)
            .into_iter()
            .collect();
        assert!(skin.iter().all(|i| found.contains(i)));
        println!("at the limit: {} of {}", found.len(), skin.len());
    }
}

#[test]
fn samples_agree() {
    let mut random = Random(33);
    let (mut hidden, mut shown) = (0, 0);
    for (count, half, low, margin) in [
        (60, 1.0, 0.3, 0.0),
        (60, 1.0, 0.3, 0.1),
        (200, 1.5, 0.4, 0.0),
        (200, 1.5, 0.4, 0.05),
        (100, 0.8, 0.9, 0.0),
    ] {
        let points: Vec<[f64; 3]> = (0..count).map(|_| random.point(half)).collect();
        let radii: Vec<f64> = (0..count).map(|_| random.within(low, 1.0)).collect();
        let outer = outer_layer(&points, &radii, margin, 0.0);
        for i in 0..count {
            let (centre, r) = (Vector3::from(points[i]), radii[i] * (1.0 + margin));
            let is_free = |v: Vector3<f64>| {
                let p = centre + v * r;
                points.iter().zip(&radii).enumerate().all(|(j, (c, r))| {
                    j == i || (p - Vector3::from(*c)).norm_squared() > r * r * (1.0 + 1e-12)
                })
            };
            let found = (0..20_000).any(|_| is_free(random.direction()));
            if outer.contains(&(i as u32)) {
                shown += i32::from(!found);
            } else {
                hidden += 1;
                assert!(!found, "sphere {i} is free");
            }
        }
    }
    println!("{hidden} hidden, {shown} outer ones too little for 20,000 samples");
    assert!(hidden > 100 && shown < 10, "{hidden} {shown}");
}

#[test]
fn fifty_thousand_spheres_take_little_time() {
    let mut random = Random(34);
    for half in [40.0, 20.0, 14.0] {
        let points: Vec<[f64; 3]> = (0..50_000).map(|_| random.point(half)).collect();
        let radii: Vec<f64> = (0..50_000).map(|_| random.within(0.5, 1.0)).collect();
        let start = Instant::now();
        let outer = outer_layer(&points, &radii, 0.05, 0.0);
        println!("half {half}: {} outer, {:?}", outer.len(), start.elapsed());
    }
    let (points, skin) = lattice(37, 1.0);
    let start = Instant::now();
    assert_eq!(
        outer_layer(&points, &vec![1.0; points.len()], 0.0, 0.0),
        skin
    );
    println!("block of {}: {:?}", points.len(), start.elapsed());
}
