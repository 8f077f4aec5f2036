//! Searches for what is near, compared with all spheres and all triangles one by one.

use crate::helpers::solids::{
    between, icosphere, point_between, random_numbers, surface_of, torus,
};
use dem_pack::internals::{Boundary, Grid, ReducedSphere, SizeClasses, Vector3, WallLists};
use proptest::prelude::*;

/// Spheres in a box whose edges are 1, 2 and 3, of radii that differ by up to the factor `ratio`.
fn spheres(number: usize, ratio: f64, seed: u64) -> Vec<ReducedSphere> {
    let mut random = random_numbers(seed);
    let sphere = |_| {
        let [x, y, z] = point_between(&mut random, [0.0; 3], [1.0, 2.0, 3.0]);
        let radius = 0.3 * ratio.powf(-between(&mut random, 0.0, 1.0));
        [x, y, z, radius]
    };
    (0..number).map(sphere).collect()
}

fn gap(a: &ReducedSphere, b: &ReducedSphere) -> f64 {
    let d = Vector3::new(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    d.norm() - a[3] - b[3]
}

proptest! {
    #[test]
    fn size_classes_hold_each_sphere_once_and_find_all_within_the_skin(
        number in 1..300_usize, ratio in 1.0..200.0, skin in 0.0..0.2, seed in 0..u64::MAX
    ) {
        let all = spheres(number, ratio, seed);
        let classes = SizeClasses::new(&all, skin);
        for ball in &all {
            let mut found = vec![0; all.len()];
            classes.near(ball, |row| {
                for k in row.spheres.clone() {
                    let i = row.numbers[k];
                    assert_eq!(row.coordinates.map(|numbers| numbers[k]), all[i as usize]);
                    found[i as usize] += 1;
                }
            });
            for (other, times) in all.iter().zip(found) {
                let least = usize::from(gap(ball, other) < skin);
                prop_assert!(least <= times && times <= 1);
            }
        }
    }

    #[test]
    fn the_grid_of_the_front_finds_all_spheres_within_the_gap(
        number in 1..300_usize, ratio in 1.0..200.0, reach in 0.0..0.5, seed in 0..u64::MAX
    ) {
        let all = spheres(number, ratio, seed);
        let corners = [Vector3::zeros(), Vector3::new(1.0, 2.0, 3.0)];
        let mut grid = Grid::new(&corners[0], &corners[1], [0.3 / ratio, 0.3], 20_000);
        all.iter().for_each(|sphere| grid.insert(*sphere));
        for point in spheres(20, 1.0, !seed) {
            let mut found = Vec::new();
            grid.near([point[0], point[1], point[2]], reach, |cell| found.extend_from_slice(cell));
            let point = [point[0], point[1], point[2], 0.0];
            for other in all.iter().filter(|other| gap(&point, other) < reach) {
                prop_assert_eq!(found.iter().filter(|sphere| *sphere == other).count(), 1);
            }
        }
    }
}

/// Before and after spheres have moved, each has all triangles in its list that it could touch
/// after a further move of half the skin.
#[test]
fn lists_of_the_wall_hold_the_triangles_within_reach() {
    const ENLARGE: f64 = 1.25;
    let mut random = random_numbers(5);
    for facets in [
        torus(20.0, 5.0, 60, 24),
        icosphere(3, &|d| 5.0 + (4.0 * d[0]).sin()),
    ] {
        let (surface, boundary) = surface_of(&facets);
        let skin = 0.05;
        let mut sphere = || {
            let [x, y, z] = point_between(&mut random, [0.0; 3], surface.extent());
            [x, y, z, between(&mut random, 0.02, 0.1)]
        };
        let mut spheres: Vec<ReducedSphere> = (0..1500).map(|_| sphere()).collect();
        let mut lists = WallLists::new(&boundary, &spheres, ENLARGE, skin);
        assert_lists_are_complete(&lists, &boundary, &spheres, ENLARGE, skin);
        for most in [0.1, 0.3, 0.5, 2.0] {
            for sphere in &mut spheres {
                let by = skin * between(&mut random, 0.0, most);
                sphere[between(&mut random, 0.0, 3.0) as usize] += by;
            }
            lists.renew(&spheres);
            assert_lists_are_complete(&lists, &boundary, &spheres, ENLARGE, skin);
        }
    }
}

fn assert_lists_are_complete(
    lists: &WallLists,
    boundary: &Boundary,
    spheres: &[ReducedSphere],
    enlarge: f64,
    skin: f64,
) {
    let mut found = vec![Vec::new(); spheres.len()];
    for (i, triangles) in lists.triangles() {
        found[i].extend(triangles.numbers());
        assert_eq!(triangles.count(), found[i].len());
    }
    let mut most = 0;
    for (sphere, mut found) in spheres.iter().zip(found) {
        let centre = Vector3::new(sphere[0], sphere[1], sphere[2]);
        let reach = enlarge * sphere[3] + 0.5 * skin;
        let wanted = near_one_by_one(boundary, &centre, reach);
        most = most.max(wanted.len());
        assert!(wanted.iter().all(|triangle| found.contains(triangle)));
        found.sort_unstable();
        assert!(found.is_sorted_by(|a, b| a < b), "one twice");
    }
    assert!(most > 3, "{most}");
}

fn near_one_by_one(boundary: &Boundary, point: &Vector3, reach: f64) -> Vec<u32> {
    let is_near = |t: &u32| boundary.nearest_on(*t, point).distance < reach;
    let all = boundary.triangles_near(point, f64::INFINITY);
    all.filter(is_near).collect()
}
