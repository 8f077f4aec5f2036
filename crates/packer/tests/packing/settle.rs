//! Settling: overlapping spheres are pushed apart and away from the wall, and spheres are taken out
//! if there is no room.

use crate::helpers::exact::assert_exact;
use crate::helpers::facets::{Facets, cuboid};
use crate::helpers::solids::{
    between, icosphere, local_facets, point_between, random_numbers, surface_of,
};
use dem_pack::internals::Boundary;
use dem_pack::internals::ReducedSphere;
use dem_pack::internals::Vector3;
use dem_pack::internals::is_inside;
use dem_pack::internals::{Settled, WhenJammed, minimise_overlaps};
use std::f64::consts::PI;

/// Spheres at random places inside until their reduced volumes are this fraction of the solid.
/// Distances to each other and to the wall are at least the fraction `apart` of those at contact.
fn cloud(
    facets: &Facets,
    fraction: f64,
    sizes: [f64; 2],
    overlap: f64,
    apart: f64,
    seed: u64,
) -> (Facets, Vec<ReducedSphere>, Boundary) {
    let (surface, boundary) = surface_of(facets);
    let unit_mm = surface.unit_m * 1e3;
    let volume = surface.volume_m3() / surface.unit_m.powi(3);
    let mut random = random_numbers(seed);
    let mut balls: Vec<ReducedSphere> = Vec::new();
    let mut filled = 0.0;
    while filled < fraction * volume {
        let radius = between(&mut random, 0.5 * sizes[0], 0.5 * sizes[1]) / unit_mm;
        let place = point_between(&mut random, [0.0; 3], surface.extent());
        let centre = Vector3::from(place);
        let reduced = radius / (1.0 + overlap);
        let free = balls.iter().all(|b| {
            let d = (centre - Vector3::new(b[0], b[1], b[2])).norm();
            d >= apart * (reduced + b[3])
        });
        if free && is_inside(&boundary, &centre) && boundary.clears(&centre, apart * radius) {
            balls.push([place[0], place[1], place[2], reduced]);
            filled += 4.0 / 3.0 * PI * reduced.powi(3);
        }
    }
    (local_facets(&surface), balls, boundary)
}

fn assert_settled(name: &str, facets: &Facets, balls: &[ReducedSphere], overlap: f64) {
    let positions: Vec<[f64; 3]> = balls.iter().map(|b| [b[0], b[1], b[2]]).collect();
    let radii: Vec<f64> = balls.iter().map(|b| b[3] * (1.0 + overlap)).collect();
    assert_exact(name, facets, &positions, &radii, overlap, 0.0);
}

/// Sizes, sorted.
fn sizes_of(balls: &[ReducedSphere]) -> Vec<f64> {
    let mut sizes: Vec<f64> = balls.iter().map(|b| b[3]).collect();
    sizes.sort_by(f64::total_cmp);
    sizes
}

/// Settles clouds below jamming. In the end no spheres overlap, none are missing and the sizes are
/// unchanged.
fn assert_clouds_settle(apart: f64) {
    let cases = [
        ("box", cuboid([10.0, 8.0, 7.0]), 0.40, 0.0, 1),
        ("box, overlap", cuboid([10.0, 8.0, 7.0]), 0.45, 0.25, 2),
        ("ball", icosphere(2, &|_| 5.0), 0.45, 0.1, 3),
    ];
    for (name, facets, fraction, overlap, seed) in cases {
        let (facets, mut balls, boundary) =
            cloud(&facets, fraction, [0.8, 1.2], overlap, apart, seed);
        let before = sizes_of(&balls);
        let settled =
            minimise_overlaps(&boundary, &mut balls, overlap, WhenJammed::TakeOut, &|_| {
                Ok(())
            })
            .unwrap();
        assert_settled(name, &facets, &balls, overlap);
        assert!(settled.steps > 0, "{name}");
        let after = sizes_of(&balls);
        assert_eq!(after.len(), before.len() - settled.taken_out, "{name}");
        assert_eq!(settled.taken_out, 0, "{name}");
        assert!(
            after
                .iter()
                .zip(&before)
                .all(|(a, b)| (a / b - 1.0).abs() < 4e-15),
            "{name}"
        );
    }
}

#[test]
fn below_jamming_spheres_that_overlap_by_a_third_come_apart() {
    assert_clouds_settle(0.67);
}

/// Some centres lie almost on each other, and almost on the wall: none may be pushed through it.
#[test]
fn below_jamming_spheres_thrown_in_at_random_come_apart_inside() {
    assert_clouds_settle(0.05);
}

#[test]
fn where_there_is_no_room_spheres_are_taken_out() {
    let (facets, mut balls, boundary) =
        cloud(&cuboid([10.0, 8.0, 7.0]), 0.68, [0.9, 1.3], 0.0, 0.67, 4);
    let before = balls.len();
    let settled =
        minimise_overlaps(&boundary, &mut balls, 0.0, WhenJammed::TakeOut, &|_| Ok(())).unwrap();
    assert_settled("jammed", &facets, &balls, 0.0);
    assert!(settled.taken_out > 0);
    assert_eq!(balls.len(), before - settled.taken_out);
    assert!(
        balls.len() as f64 > 0.75 * before as f64,
        "{} of {before} are left",
        balls.len()
    );
}

/// Before any is taken out for its overlap, some are left out evenly. The mean size is off by no
/// more than chance allows.
#[test]
fn where_there_is_little_room_spheres_are_left_out_evenly() {
    let (facets, mut balls, boundary) =
        cloud(&cuboid([10.0, 8.0, 7.0]), 0.6, [0.9, 1.1], 0.0, 0.67, 6);
    let before = sizes_of(&balls);
    let settled =
        minimise_overlaps(&boundary, &mut balls, 0.0, WhenJammed::ThinOut, &|_| Ok(())).unwrap();
    assert_settled("little room", &facets, &balls, 0.0);
    assert!(settled.thinned > 0);
    assert!(settled.thinned as f64 <= 0.03 * before.len() as f64);
    let missing = settled.thinned + settled.taken_out;
    assert_eq!(balls.len(), before.len() - missing);
    let mean = |sizes: &[f64]| sizes.iter().sum::<f64>() / sizes.len() as f64;
    let spread = (before
        .iter()
        .map(|r| (r - mean(&before)).powi(2))
        .sum::<f64>()
        / before.len() as f64)
        .sqrt();
    let off = (mean(&sizes_of(&balls)) - mean(&before)).abs();
    let chance = spread * (missing as f64).sqrt() / before.len() as f64;
    assert!(off < 3.0 * chance, "{off} of {chance}");
}

/// Spheres thicker than the plate touch no others: the wall alone jams them.
#[test]
fn spheres_that_only_the_wall_jams_are_taken_out() {
    let (surface, boundary) = surface_of(&cuboid([10.0, 8.0, 2.0]));
    let local = |mm: f64| mm * 1e-3 / surface.unit_m;
    let mut balls: Vec<ReducedSphere> =
        [(1.5, 1.1), (3.5, 0.9), (5.5, 1.1), (7.5, 0.9), (8.9, 0.5)]
            .map(|(x, radius)| [local(x), local(4.0), local(1.0), local(radius)])
            .to_vec();
    let settled =
        minimise_overlaps(&boundary, &mut balls, 0.0, WhenJammed::TakeOut, &|_| Ok(())).unwrap();
    assert_eq!(settled.taken_out, 2);
    let left: Vec<f64> = sizes_of(&balls)
        .iter()
        .map(|r| (r / local(1.0) * 1e9).round())
        .collect();
    assert_eq!(left, [5e8, 9e8, 9e8]);
    assert_settled("plate", &local_facets(&surface), &balls, 0.0);
}

#[test]
fn what_does_not_overlap_stays_where_it_is() {
    let (_, boundary) = surface_of(&cuboid([10.0, 8.0, 7.0]));
    let mut balls: Vec<ReducedSphere> = (0..4)
        .flat_map(|i| {
            (0..3).map(move |j| {
                [
                    0.2 + 0.25 * f64::from(i),
                    0.2 + 0.25 * f64::from(j),
                    0.3,
                    0.1,
                ]
            })
        })
        .collect();
    let before = balls.clone();
    assert_eq!(
        minimise_overlaps(&boundary, &mut balls, 0.0, WhenJammed::TakeOut, &|_| Ok(())).unwrap(),
        Settled {
            steps: 0,
            thinned: 0,
            taken_out: 0
        }
    );
    for (a, b) in balls.iter().zip(&before) {
        assert_eq!(a[..3], b[..3]);
        assert!((a[3] / b[3] - 1.0).abs() < 1e-15);
    }
}

#[test]
fn two_spheres_part_along_the_line_of_their_centres() {
    let (_, boundary) = surface_of(&cuboid([10.0, 10.0, 10.0]));
    let mut balls = vec![[0.55, 0.6, 0.6, 0.1], [0.7, 0.6, 0.6, 0.1]];
    minimise_overlaps(&boundary, &mut balls, 0.0, WhenJammed::TakeOut, &|_| Ok(())).unwrap();
    assert!(balls[1][0] - balls[0][0] >= 0.2);
    assert!((balls[0][0] + balls[1][0] - 1.25).abs() < 1e-12);
    assert!(
        balls
            .iter()
            .all(|b| (b[1] - 0.6).abs() < 1e-14 && (b[2] - 0.6).abs() < 1e-14)
    );
}

#[test]
fn no_spheres_and_one_sphere() {
    let (_, boundary) = surface_of(&cuboid([10.0, 10.0, 10.0]));
    let mut none = Vec::new();
    assert_eq!(
        minimise_overlaps(&boundary, &mut none, 0.0, WhenJammed::TakeOut, &|_| Ok(()))
            .unwrap()
            .steps,
        0
    );
    // Pushed away from the wall to where it fits.
    let mut one = vec![[0.05, 0.6, 0.6, 0.1]];
    minimise_overlaps(&boundary, &mut one, 0.0, WhenJammed::TakeOut, &|_| Ok(())).unwrap();
    assert_eq!(one.len(), 1);
    assert!(one[0][0] >= 0.1);
}

#[test]
fn what_progress_says_ends_it() {
    let (_, mut balls, boundary) = cloud(&cuboid([10.0, 8.0, 7.0]), 0.3, [0.8, 1.2], 0.0, 0.6, 9);
    let stopped = minimise_overlaps(&boundary, &mut balls, 0.0, WhenJammed::TakeOut, &|_| {
        Err(dem_io::Diagnostic::failed("here", "stopped", ""))
    });
    assert_eq!(stopped.unwrap_err().problem, "stopped");
}
