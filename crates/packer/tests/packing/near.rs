//! Searches for what is near, compared with all spheres and all triangles one by one.

use crate::helpers::solids::{
    between, icosphere, point_between, random_numbers, surface_of, torus,
};
use dem_pack::internals::{Boundary, Grid, ReducedSphere, SizeClasses, Vector3, WallCells};
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
            classes.near(ball, |spheres, numbers| {
                for (sphere, i) in spheres.iter().zip(numbers) {
                    assert_eq!(*sphere, all[*i as usize]);
                    found[*i as usize] += 1;
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

/// The same triangles in the same order as those of the tree that are near enough.
#[test]
fn cells_of_the_wall_hold_the_triangles_within_reach() {
    let mut random = random_numbers(5);
    for facets in [
        torus(20.0, 5.0, 60, 24),
        icosphere(3, &|d| 5.0 + (4.0 * d[0]).sin()),
    ] {
        let (surface, boundary) = surface_of(&facets);
        let extent = surface.extent();
        let mean = extent.iter().sum::<f64>() / 3.0;
        let range = [0.01 * mean, 0.2 * mean];
        for most_cells in [100, 20_000] {
            let cells = WallCells::new(&boundary, range, most_cells);
            for _ in 0..300 {
                let reach = between(&mut random, range[0], range[1]);
                let low = [-0.5 * mean; 3];
                let point = point_between(&mut random, low, extent.map(|e| e + 0.5 * mean));
                let point = Vector3::from(point);
                let found: Vec<u32> = cells.near(&point, reach).collect();
                assert_eq!(found, near_one_by_one(&boundary, &point, reach));
            }
        }
    }
}

fn near_one_by_one(boundary: &Boundary, point: &Vector3, reach: f64) -> Vec<u32> {
    let is_near = |t: &u32| boundary.nearest_on(*t, point).distance < reach;
    boundary
        .triangles_near(point, reach)
        .filter(is_near)
        .collect()
}
