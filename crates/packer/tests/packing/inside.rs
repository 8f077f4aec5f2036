//! Points inside, compared with winding numbers and closed forms, and rays that meet the surface.

use crate::helpers::exact::{length, winding_number};
use crate::helpers::facets::{Facets, Point, cuboid, rounded};
use crate::helpers::solids::{
    icosphere, local_facets, point_between, random_numbers, surface_of, torus, turned,
    turned_inside_out,
};
use dem_io::Surface;
use dem_pack::internals::Boundary;
use dem_pack::internals::Vector3;
use dem_pack::internals::{self, first_hit};

/// A point of the file (mm) in local units.
fn local(surface: &Surface, p: Point) -> Vector3 {
    Vector3::from([0, 1, 2].map(|k| (p[k] * 1e-3 - surface.origin_m[k]) / surface.unit_m))
}

fn is_inside((surface, boundary): &(Surface, Boundary), p: Point) -> bool {
    internals::is_inside(boundary, &local(surface, p))
}

#[test]
fn agrees_with_the_winding_number_everywhere_around_a_torus() {
    let mut random = random_numbers(1);
    for facets in [
        torus(20.0, 5.0, 60, 24),
        turned(&mut random, torus(20.0, 5.0, 60, 24)),
        icosphere(2, &|d| 5.0 + 3.0 * (4.0 * d[0]).sin()),
    ] {
        let (surface, boundary) = surface_of(&facets);
        let facets = local_facets(&surface);
        let extent = surface.extent();
        let mut inside = 0;
        for _ in 0..5000 {
            let p = point_between(
                &mut random,
                extent.map(|e| -0.05 * e),
                extent.map(|e| 1.05 * e),
            );
            let wanted = winding_number(&facets, &p) > 0;
            assert_eq!(
                internals::is_inside(&boundary, &Vector3::from(p)),
                wanted,
                "{p:?}"
            );
            inside += usize::from(wanted);
        }
        assert!(inside > 500);
    }
}

/// A box whose faces are cut into squares of edge 1, each of two triangles.
fn tiled_box(counts: [usize; 3]) -> Facets {
    let mut facets = Facets::new();
    for normal in 0..3 {
        let (u, v) = ((normal + 1) % 3, (normal + 2) % 3);
        for (i, j) in (0..counts[u]).flat_map(|i| (0..counts[v]).map(move |j| (i, j))) {
            for side in [0, counts[normal]] {
                let at = |i: usize, j: usize| {
                    let mut p = [0.0; 3];
                    (p[normal], p[u], p[v]) = (side as f64, i as f64, j as f64);
                    p
                };
                let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                let [a, b, c, d] = if side == 0 {
                    [quad[0], quad[3], quad[2], quad[1]]
                } else {
                    quad
                };
                facets.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    facets
}

#[test]
fn points_in_line_with_vertices_and_edges_are_decided() {
    let solid = surface_of(&tiled_box([8, 4, 4]));
    // Half squares: on the planes, edges and diagonals of the tiling drawn on, inside and out.
    for (i, j, k) in
        (-3..20).flat_map(|i| (-3..12).flat_map(move |j| (-3..12).map(move |k| (i, j, k))))
    {
        let p = [i, j, k].map(|x| 0.5 * f64::from(x));
        let on_surface = (0..3).any(|n| p[n] == 0.0 || p[n] == [8.0, 4.0, 4.0][n]);
        if !on_surface {
            let wanted = (0..3).all(|n| p[n] > 0.0 && p[n] < [8.0, 4.0, 4.0][n]);
            assert_eq!(is_inside(&solid, p), wanted, "{p:?}");
        }
    }
}

#[test]
fn rays_aimed_at_vertices_and_edges_are_decided() {
    // The first directions that are tried, and the distance of the ray's start from its target.
    let directions = [
        [0.577_215_66, 0.321_309_89, 0.751_988_48],
        [-0.414_213_56, 0.732_050_81, 0.540_963_27],
        [0.236_067_98, -0.645_751_31, 0.726_172_92],
    ];
    let solid = surface_of(&tiled_box([8, 4, 4]));
    let facets = tiled_box([8, 4, 4]);
    let corner_weights = [
        [1.0, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.25, 0.75, 0.0],
        [0.0, 0.5, 0.5],
    ];
    let mut inside = 0;
    for (corners, weights) in facets
        .iter()
        .flat_map(|f| corner_weights.iter().map(move |w| (f, w)))
    {
        let aim = [0, 1, 2].map(|k| (0..3).map(|c| weights[c] * corners[c][k]).sum::<f64>());
        for (direction, start) in directions
            .iter()
            .flat_map(|d| [0.3, 1.0, 2.0, 9.0].map(|s| (d, s)))
        {
            let p = [0, 1, 2].map(|k| aim[k] - start * direction[k]);
            if (0..3).any(|k| p[k].abs() < 1e-6 || (p[k] - [8.0, 4.0, 4.0][k]).abs() < 1e-6) {
                continue;
            }
            let wanted = (0..3).all(|k| p[k] > 0.0 && p[k] < [8.0, 4.0, 4.0][k]);
            assert_eq!(is_inside(&solid, p), wanted, "{p:?}");
            inside += usize::from(wanted);
        }
    }
    assert!(inside > 100);
}

#[test]
fn very_near_the_surface_the_side_is_right() {
    let solid = surface_of(&cuboid([8.0, 4.0, 4.0]));
    for (y, z) in [(1.0, 1.0), (2.0, 2.0), (0.5, 3.5), (1e-7, 1e-7)] {
        assert!(is_inside(&solid, [1e-8, y, z]) && !is_inside(&solid, [-1e-8, y, z]));
        assert!(is_inside(&solid, [8.0 - 1e-8, y, z]) && !is_inside(&solid, [8.0 + 1e-8, y, z]));
    }
}

#[test]
fn a_cavity_is_outside_and_what_lies_in_it_is_inside() {
    let mut facets = icosphere(2, &|_| 10.0);
    facets.extend(turned_inside_out(icosphere(2, &|_| 6.0)));
    facets.extend(icosphere(2, &|_| 2.0));
    let solid = surface_of(&facets);
    let mut random = random_numbers(2);
    for _ in 0..2000 {
        let p = point_between(&mut random, [-11.0; 3], [11.0; 3]);
        let r = length(p);
        // Facets of the second subdivision lie at most 5 % deep.
        if [2.0, 6.0, 10.0]
            .iter()
            .all(|wall| r > wall * 1.0001 || r < wall * 0.95)
        {
            assert_eq!(
                is_inside(&solid, p),
                r < 2.0 || (r > 6.0 && r < 10.0),
                "{p:?}"
            );
        }
    }
}

#[test]
fn shells_that_cross_form_their_union() {
    let mut facets = cuboid([10.0, 4.0, 4.0]);
    let shift = |p: Point| [p[0] + 3.0, p[1] - 2.0, p[2] + 1.0];
    facets.extend(
        rounded(cuboid([3.0, 8.0, 2.0]))
            .into_iter()
            .map(|c| c.map(shift)),
    );
    let solid = surface_of(&facets);
    let mut random = random_numbers(3);
    for _ in 0..5000 {
        let p = point_between(&mut random, [-1.0, -3.0, -1.0], [11.0, 7.0, 5.0]);
        let within = |low: Point, high: Point| (0..3).all(|k| p[k] > low[k] && p[k] < high[k]);
        let wanted =
            within([0.0; 3], [10.0, 4.0, 4.0]) || within([3.0, -2.0, 1.0], [6.0, 6.0, 3.0]);
        assert_eq!(is_inside(&solid, p), wanted, "{p:?}");
    }
}

#[test]
fn a_ray_meets_the_wall_where_it_stands() {
    let (surface, boundary) = surface_of(&tiled_box([8, 4, 4]));
    let mut random = random_numbers(4);
    for _ in 0..1000 {
        let p = point_between(&mut random, [0.1; 3], [7.9, 3.9, 3.9]);
        let direction = Vector3::from(point_between(&mut random, [-1.0; 3], [1.0; 3])).normalize();
        let wall = (0..3)
            .map(|k| {
                if direction[k] > 0.0 {
                    ([8.0, 4.0, 4.0][k] - p[k]) / direction[k]
                } else {
                    -p[k] / direction[k]
                }
            })
            .fold(f64::INFINITY, f64::min);
        let hit = first_hit(&boundary, &local(&surface, p), &direction, 0.0).unwrap();
        assert!(
            (hit * surface.unit_m * 1e3 - wall).abs() < 1e-9,
            "{p:?} {direction:?}: {hit} {wall}"
        );
    }
}

#[test]
fn near_the_wall_the_nearest_triangle_tells_the_side() {
    let mut random = random_numbers(5);
    let crossing = |p: Point| [p[0] + 3.0, p[1] - 2.0, p[2] + 1.0];
    let other = rounded(cuboid([3.0, 8.0, 2.0]));
    let crossed = other.into_iter().map(|corners| corners.map(crossing));
    let touching = cuboid([2.0, 2.0, 2.0]).into_iter();
    let touching = touching.map(|corners| corners.map(|p| [p[0] + 10.0, p[1] + 1.0, p[2] + 1.0]));
    for facets in [
        torus(20.0, 5.0, 60, 24),
        icosphere(2, &|d| 5.0 + 3.0 * (4.0 * d[0]).sin()),
        cuboid([10.0, 4.0, 4.0])
            .into_iter()
            .chain(crossed)
            .collect(),
        cuboid([10.0, 4.0, 4.0])
            .into_iter()
            .chain(touching)
            .collect(),
    ] {
        let (surface, boundary) = surface_of(&facets);
        let (mut decided, mut tried) = (0, 0);
        for corners in local_facets(&surface) {
            for _ in 0..2000 / facets.len() + 4 {
                let weights = point_between(&mut random, [0.0; 3], [1.0; 3]);
                let sum: f64 = weights.iter().sum();
                let on = |k: usize| {
                    (0..3)
                        .map(|c| weights[c] / sum * corners[c][k])
                        .sum::<f64>()
                };
                let off = 10.0_f64.powf(point_between(&mut random, [-9.0; 3], [-2.0; 3])[0]);
                let way = point_between(&mut random, [-off; 3], [off; 3]);
                let p = Vector3::new(on(0) + way[0], on(1) + way[1], on(2) + way[2]);
                let near = boundary.triangles_near(&p, 2.0 * off + 1e-6);
                tried += 1;
                if let Some(behind) = boundary.is_behind_nearest(near, &p) {
                    assert_eq!(behind, internals::is_inside(&boundary, &p), "{p:?}");
                    decided += 1;
                }
            }
        }
        assert!(4 * decided > 3 * tried, "{decided} of {tried}");
    }
}

#[test]
fn at_edges_and_where_parts_touch_the_nearest_triangle_does_not_tell() {
    let mut facets = cuboid([4.0, 4.0, 4.0]);
    let beside = cuboid([2.0, 2.0, 2.0]).into_iter();
    facets.extend(beside.map(|corners| corners.map(|p| [p[0] + 4.0, p[1] + 1.0, p[2] + 1.0])));
    let (surface, boundary) = surface_of(&facets);
    let behind = |p: Point| {
        let p = local(&surface, p);
        boundary.is_behind_nearest(boundary.triangles_near(&p, 0.1), &p)
    };
    assert_eq!(behind([3.9, 0.4, 0.5]), Some(true));
    assert_eq!(behind([4.1, 0.4, 0.5]), Some(false));
    assert_eq!(behind([4.1, -0.1, 2.0]), None);
    for x in [3.9, 4.1] {
        assert_eq!(behind([x, 1.9, 2.2]), None);
    }
    assert_eq!(
        boundary.is_behind_nearest(std::iter::empty(), &Vector3::zeros()),
        None
    );
}
