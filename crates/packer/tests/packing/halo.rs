//! Corners of a halo compared with a separately computed three-sphere intersection.

use crate::helpers::exact::largest_overlap;
use crate::helpers::solids::{between, point_between, random_numbers};
use dem_pack::internals::ReducedSphere;
use dem_pack::internals::Vector3;
use dem_pack::internals::{Halo, Neighbours};
use rand::rngs::ChaCha8Rng;

/// A front sphere in the middle and others around it, none overlapping another.
fn crowd(random: &mut ChaCha8Rng) -> Vec<ReducedSphere> {
    let mut balls = vec![[0.0, 0.0, 0.0, between(random, 0.5, 1.0)]];
    for _ in 0..400 {
        let [x, y, z] = point_between(random, [-3.0; 3], [3.0; 3]);
        let ball = [x, y, z, between(random, 0.4, 1.0)];
        if balls.iter().all(|other| gap(other, &ball) > 0.0) {
            balls.push(ball);
        }
    }
    balls
}

fn centre(ball: &ReducedSphere) -> Vector3 {
    Vector3::new(ball[0], ball[1], ball[2])
}

fn gap(a: &ReducedSphere, b: &ReducedSphere) -> f64 {
    (centre(a) - centre(b)).norm() - a[3] - b[3]
}

/// Centres of the spheres of radius `new` that touch three others.
fn touching_three(
    a: &ReducedSphere,
    b: &ReducedSphere,
    c: &ReducedSphere,
    new: f64,
) -> Vec<Vector3> {
    let (ra, rb, rc) = (a[3] + new, b[3] + new, c[3] + new);
    let (ab, ac) = (centre(b) - centre(a), centre(c) - centre(a));
    let d = ab.norm();
    let ex = ab / d;
    let i = ex.dot(&ac);
    let off = ac - ex * i;
    let j = off.norm();
    let ey = off / j;
    let x = (ra * ra - rb * rb + d * d) / (2.0 * d);
    let y = (ra * ra - rc * rc + i * i + j * j - 2.0 * i * x) / (2.0 * j);
    let z_squared = ra * ra - x * x - y * y;
    if z_squared <= 0.0 {
        return Vec::new();
    }
    let foot = centre(a) + ex * x + ey * y;
    let up = ex.cross(&ey) * z_squared.sqrt();
    vec![foot + up, foot - up]
}

/// The best corner by the halo's own search.
fn best_corner(halo: &mut Halo, wanted: &Vector3) -> Option<Vector3> {
    let mut best = None;
    halo.corners(wanted, f64::NEG_INFINITY, |place| {
        best = Some(*place);
        true
    });
    best
}

#[test]
fn corners_touch_three_spheres_overlap_none_and_the_best_is_found() {
    let mut random = random_numbers(1);
    let (mut halo, mut neighbours) = (Halo::default(), Neighbours::default());
    let mut found = 0;
    for case in 0..300 {
        let balls = crowd(&mut random);
        let new = between(&mut random, 0.3, 0.9);
        neighbours.clear();
        neighbours.gather(&balls[0], &balls, new);
        halo.set(&balls[0], new, &neighbours);
        let wanted = Vector3::from(point_between(&mut random, [-1.0; 3], [1.0; 3]));
        let free = |p: &Vector3| {
            balls
                .iter()
                .all(|b| (p - centre(b)).norm() - b[3] - new > -1e-11)
        };
        let mut least = f64::INFINITY;
        for j in 1..balls.len() {
            for k in j + 1..balls.len() {
                for p in touching_three(&balls[0], &balls[j], &balls[k], new) {
                    if free(&p) {
                        least = least.min(p.dot(&wanted));
                    }
                }
            }
        }
        let Some(place) = best_corner(&mut halo, &wanted) else {
            assert_eq!(
                least,
                f64::INFINITY,
                "case {case}: a free corner was not found"
            );
            continue;
        };
        found += 1;
        assert!(
            (place.dot(&wanted) - least).abs() < 1e-9,
            "case {case}: {} {least}",
            place.dot(&wanted)
        );
        let new_ball = [place.x, place.y, place.z, new];
        let gaps: Vec<f64> = balls.iter().map(|b| gap(b, &new_ball)).collect();
        assert!(
            gaps[0].abs() < 1e-14 + 1e-15 * new,
            "case {case}: off the front sphere by {:e}",
            gaps[0]
        );
        let touched = gaps.iter().filter(|gap| gap.abs() < 1e-12).count();
        assert!(touched >= 3, "case {case}: touches {touched}");
        assert!(
            gaps.iter().all(|gap| *gap > -1e-11 * new),
            "case {case}: covered"
        );
    }
    assert!(found > 200, "{found}");
}

#[test]
fn every_corner_that_is_offered_is_free() {
    let mut random = random_numbers(2);
    let (mut halo, mut neighbours) = (Halo::default(), Neighbours::default());
    for _ in 0..100 {
        let balls = crowd(&mut random);
        let new = between(&mut random, 0.2, 0.6);
        neighbours.clear();
        neighbours.gather(&balls[0], &balls, new);
        halo.set(&balls[0], new, &neighbours);
        // If each is refused, all corners are offered one after the other.
        halo.corners(&Vector3::x(), f64::NEG_INFINITY, |q| {
            let mut positions: Vec<[f64; 3]> = balls.iter().map(|b| [b[0], b[1], b[2]]).collect();
            let mut radii: Vec<f64> = balls.iter().map(|b| b[3]).collect();
            positions.push([q.x, q.y, q.z]);
            radii.push(new);
            assert!(largest_overlap(&positions, &radii) < 1e-11);
            false
        });
    }
}

/// Small spheres are placed one after the other beside a large one, as by a front. What the smaller
/// ones have shown holds for the next: no place is free below it, and the best corner is found from
/// there on.
#[test]
fn no_place_is_free_below_what_smaller_sizes_have_shown() {
    let mut random = random_numbers(4);
    let (mut halo, mut neighbours) = (Halo::default(), Neighbours::default());
    let (mut known, mut restricted) = (Vec::new(), 0);
    for _ in 0..4 {
        let large = between(&mut random, 2.0, 4.0);
        let h = (large + 0.3) * (0.3 / (large + 0.3)).asin().cos();
        let mut balls = vec![
            [0.0, 0.0, 0.0, large],
            [0.3, h, 0.0, 0.3],
            [-0.3, h, 0.0, 0.3],
        ];
        let wanted = Vector3::from(point_between(&mut random, [-1.0; 3], [1.0; 3]));
        known.clear();
        for _ in 0..400 {
            let new = between(&mut random, 0.15, 0.6);
            neighbours.clear();
            neighbours.gather(&balls[0], &balls, new);
            neighbours.sort();
            halo.set(&balls[0], new, &neighbours);
            let smaller = known.iter().filter(|(size, _)| *size <= new);
            let from = smaller.fold(f64::NEG_INFINITY, |from: f64, (_, order)| from.max(*order));
            for _ in 0..50 {
                let p = Vector3::from(point_between(&mut random, [-1.0; 3], [1.0; 3])).normalize();
                let place = halo.position(&p);
                let ball = [place.x, place.y, place.z, new];
                let is_free = balls[1..].iter().all(|other| gap(other, &ball) >= 0.0);
                assert!(!is_free || p.dot(&wanted) >= from - 1e-12, "{p} {from}");
            }
            let best = best_corner(&mut halo, &wanted);
            let mut found = None;
            let least = halo.corners(&wanted, from, |place| {
                found = Some(*place);
                true
            });
            assert_eq!(found, best, "from {from}");
            restricted += usize::from(from > -wanted.norm());
            known.push((new, least));
            let Some(place) = best else { break };
            balls.push([place.x, place.y, place.z, new]);
        }
    }
    assert!(restricted > 500, "{restricted}");
}

/// Where a lone neighbour lies in the direction of the seed, no corner but the rim of its cap is
/// the first that is free, also if its axis points at the seed almost exactly.
#[test]
fn the_first_free_place_may_be_on_the_rim_of_one_cap() {
    let mut random = random_numbers(5);
    let (large, small, new) = (3.0, 0.3, 0.4);
    let (reach, distance, touching) = (large + new, large + small, small + new);
    let cosine =
        (reach * reach + distance * distance - touching * touching) / (2.0 * reach * distance);
    let mut direction =
        move || Vector3::from(point_between(&mut random, [-1.0; 3], [1.0; 3])).normalize();
    let (mut halo, mut neighbours) = (Halo::default(), Neighbours::default());
    for _ in 0..50 {
        let axis = direction();
        let ball = |towards: Vector3| {
            let place = towards * distance;
            [place.x, place.y, place.z, small]
        };
        let mut balls = vec![[0.0, 0.0, 0.0, large], ball(axis)];
        while balls.len() < 100 {
            let other = direction();
            if other.dot(&axis) < -0.5 {
                balls.push(ball(other));
            }
        }
        neighbours.clear();
        neighbours.gather(&balls[0], &balls, new);
        neighbours.sort();
        halo.set(&balls[0], new, &neighbours);
        for tilt in [0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 0.05_f64] {
            let across = axis.cross(&direction()).normalize();
            let wanted = -2.0 * (tilt.cos() * axis + tilt.sin() * across);
            let least = halo.corners(&wanted, f64::NEG_INFINITY, |_| true);
            let first = -2.0 * (cosine.acos() - tilt).cos();
            assert!((least - first).abs() < 4e-6, "{tilt}: {least} {first}");
        }
    }
}

#[test]
fn equal_spheres_side_by_side_take_a_fourth_in_a_tetrahedron() {
    let h = 3.0_f64.sqrt();
    let balls = [
        [0.0, 0.0, 0.0, 1.0],
        [2.0, 0.0, 0.0, 1.0],
        [1.0, h, 0.0, 1.0],
    ];
    let (mut halo, mut neighbours) = (Halo::default(), Neighbours::default());
    neighbours.gather(&balls[0], &balls, 1.0);
    halo.set(&balls[0], 1.0, &neighbours);
    for side in [-1.0, 1.0] {
        let place = best_corner(&mut halo, &Vector3::new(0.0, 0.0, -side)).unwrap();
        let wanted = Vector3::new(1.0, h / 3.0, side * (8.0_f64 / 3.0).sqrt());
        assert!((place - wanted).norm() < 1e-15 * 8.0, "{place}");
    }
}

#[test]
fn at_a_wall_the_new_sphere_touches_wall_neighbour_and_front_sphere() {
    let mut random = random_numbers(3);
    let (mut halo, mut neighbours) = (Halo::default(), Neighbours::default());
    let mut found = 0;
    for _ in 0..200 {
        let balls = crowd(&mut random);
        let new = between(&mut random, 0.3, 0.9);
        neighbours.clear();
        neighbours.gather(&balls[0], &balls, new);
        halo.set(&balls[0], new, &neighbours);
        let towards = Vector3::from(point_between(&mut random, [-1.0; 3], [1.0; 3])).normalize();
        let wall = between(&mut random, 1.0, 2.0);
        for j in 0..halo.neighbours() {
            for p in halo
                .wall_corners(j, &towards, wall - new)
                .into_iter()
                .flatten()
            {
                found += 1;
                let place = halo.position(&p);
                let new_ball = [place.x, place.y, place.z, new];
                assert!(
                    (place.dot(&towards) + new - wall).abs() < 1e-7,
                    "off the wall"
                );
                let touched = balls
                    .iter()
                    .filter(|b| gap(b, &new_ball).abs() < 1e-7)
                    .count();
                assert!(touched >= 2, "{touched}");
            }
        }
    }
    assert!(found > 200);
}
