//! The wall of crossing parts, compared with closed forms: it is closed, and the enclosed volume
//! and the distances are right.

use crate::helpers::exact::{
    cross, distance_to_triangle, dot, length, scaled, sub, winding_number,
};
use crate::helpers::facets::{Facets, Point};
use crate::helpers::solids::{
    icosphere, local_facets, point_between, random_numbers, random_solid, surface_of, turned,
    turned_inside_out,
};
use dem_io::Surface;
use dem_pack::internals::Boundary;
use dem_pack::internals::Vector3;
use dem_pack::internals::outer_pieces;
use rand::rngs::ChaCha8Rng;
use std::f64::consts::PI;

fn plus(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// A box with any orthogonal edges, right-handed, in mm.
#[derive(Clone, Copy)]
struct Block {
    corner: Point,
    edges: [Point; 3],
}

/// A box along the axes.
fn block(low: Point, high: Point) -> Block {
    let [x, y, z] = sub(high, low);
    Block {
        corner: low,
        edges: [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]],
    }
}

/// A box rotated about two axes so that its corners are whole numbers: edges are multiples of 65.
fn tilted(corner: Point, lengths: [f64; 3]) -> Block {
    // Rotated by the angle of the triangle 3, 4, 5 about z, then by that of 5, 12, 13 about x.
    let turn = |[x, y, z]: Point| {
        let [x, y] = [(3.0 * x - 4.0 * y) / 5.0, (4.0 * x + 3.0 * y) / 5.0];
        [x, (5.0 * y - 12.0 * z) / 13.0, (12.0 * y + 5.0 * z) / 13.0]
    };
    let [a, b, c] = lengths;
    Block {
        corner,
        edges: [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]].map(turn),
    }
}

impl Block {
    /// The six faces, counter-clockwise seen from outside.
    fn faces(&self) -> Vec<[Point; 4]> {
        (0..3)
            .flat_map(|k| {
                let [u, v, w] = [0, 1, 2].map(|i| self.edges[(k + i) % 3]);
                let (o, top) = (self.corner, plus(self.corner, w));
                [
                    [o, plus(o, v), plus(plus(o, u), v), plus(o, u)],
                    [top, plus(top, u), plus(plus(top, u), v), plus(top, v)],
                ]
            })
            .collect()
    }

    fn facets(&self) -> Facets {
        self.faces()
            .into_iter()
            .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect()
    }

    fn volume(&self) -> f64 {
        dot(self.edges[0], cross(self.edges[1], self.edges[2]))
    }

    /// The convex polygons that remain of a convex polygon when the inside of the box is removed.
    fn taken_from(&self, polygon: Vec<Point>) -> Vec<Vec<Point>> {
        let mut rest = Vec::new();
        let mut inner = polygon;
        for [a, b, c, _] in self.faces() {
            let normal = cross(sub(b, a), sub(c, a));
            let height = |p: &Point| dot(sub(*p, a), normal) / length(normal);
            rest.push(clipped(&inner, &height));
            inner = clipped(&inner, &|p| -height(p));
            // A face that lies in the plane of another is not inside.
            if inner.iter().all(|p| height(p) > -1e-9) {
                break;
            }
        }
        rest.retain(|piece| piece.len() > 2);
        rest
    }
}

/// The part of a convex polygon where the height is not negative.
fn clipped(polygon: &[Point], height: &dyn Fn(&Point) -> f64) -> Vec<Point> {
    let mut kept = Vec::new();
    for k in 0..polygon.len() {
        let (p, q) = (polygon[k], polygon[(k + 1) % polygon.len()]);
        let (h, g) = (height(&p), height(&q));
        if h >= 0.0 {
            kept.push(p);
        }
        if h * g < 0.0 {
            kept.push(plus(p, scaled(sub(q, p), h / (h - g))));
        }
    }
    kept
}

/// The boundary of the union of boxes, as triangles in mm.
fn boundary_of_union(blocks: &[Block]) -> Facets {
    let mut triangles = Facets::new();
    for (i, own) in blocks.iter().enumerate() {
        for face in own.faces() {
            let mut pieces = vec![face.to_vec()];
            for (_, other) in blocks.iter().enumerate().filter(|(j, _)| *j != i) {
                pieces = pieces
                    .into_iter()
                    .flat_map(|p| other.taken_from(p))
                    .collect();
            }
            for piece in pieces {
                triangles.extend((2..piece.len()).map(|k| [piece[0], piece[k - 1], piece[k]]));
            }
        }
    }
    triangles
}

/// Rotated at random about the origin, which stays inside or near.
fn turned_about(random: &mut ChaCha8Rng, facets: Facets) -> Facets {
    let [a, b, c] = point_between(random, [0.0; 3], [2.0 * PI; 3]);
    let rotation = nalgebra::Rotation3::from_euler_angles(a, b, c);
    let turn = |p: Point| {
        let q = rotation * Vector3::from(p);
        [q.x, q.y, q.z].map(|x| f64::from(x as f32))
    };
    facets
        .into_iter()
        .map(|corners| corners.map(turn))
        .collect()
}

fn signed_volume(triangles: &[[Point; 3]]) -> f64 {
    let sum: f64 = triangles
        .iter()
        .map(|[a, b, c]| dot(*a, cross(*b, *c)))
        .sum();
    sum / 6.0
}

/// Deviation from a closed surface: the sum of all area vectors, as a fraction of the area.
fn gap(triangles: &[[Point; 3]]) -> f64 {
    let areas = || {
        triangles
            .iter()
            .map(|[a, b, c]| cross(sub(*b, *a), sub(*c, *a)))
    };
    let area: f64 = areas().map(length).sum();
    length(areas().fold([0.0; 3], plus)) / area
}

/// The volume that the wall encloses, in mm3. Checks that the wall is closed, and that each piece
/// has the solid behind it and nothing in front of it.
fn enclosed_mm3(surface: &Surface, boundary: &Boundary) -> f64 {
    let wall = outer_pieces(surface, boundary.facets());
    assert!(gap(&wall) < 1e-12, "open by {:e}", gap(&wall));
    let facets = local_facets(surface);
    for [a, b, c] in &wall {
        let across = cross(sub(*b, *a), sub(*c, *a));
        // The middle of a sliver is too near to other facets.
        if length(across) < 1e-8 {
            continue;
        }
        let middle = scaled(plus(plus(*a, *b), *c), 1.0 / 3.0);
        let off = scaled(across, 1e-6 / length(across));
        assert!(winding_number(&facets, &sub(middle, off)) > 0);
        assert!(winding_number(&facets, &plus(middle, off)) <= 0);
    }
    signed_volume(&wall) * (surface.unit_m * 1e3).powi(3)
}

/// Checks the distance to the wall at random points of the solid against `distance_mm`, which takes
/// points in mm.
fn assert_distances(
    surface: &Surface,
    boundary: &Boundary,
    tolerance_mm: f64,
    distance_mm: &dyn Fn(Point) -> f64,
) {
    let mut random = random_numbers(1);
    let facets = local_facets(surface);
    let mut inside = 0;
    for _ in 0..2000 {
        let p = point_between(&mut random, [0.0; 3], surface.extent());
        if winding_number(&facets, &p) <= 0 {
            continue;
        }
        inside += 1;
        let found = boundary.nearest(&Vector3::from(p), f64::MAX).unwrap();
        let found = found.distance * surface.unit_m * 1e3;
        let mm = [0, 1, 2].map(|k| 1e3 * (surface.origin_m[k] + surface.unit_m * p[k]));
        let wanted = distance_mm(mm);
        assert!(
            (found - wanted).abs() <= tolerance_mm,
            "{mm:?}: {found} {wanted}"
        );
    }
    assert!(inside > 300, "{inside}");
}

fn distance_to(triangles: &[[Point; 3]], p: &Point) -> f64 {
    triangles
        .iter()
        .map(|triangle| distance_to_triangle(p, triangle))
        .fold(f64::INFINITY, f64::min)
}

fn assert_union_of_blocks(blocks: &[Block], coplanar: bool) {
    let facets: Facets = blocks.iter().flat_map(Block::facets).collect();
    let (surface, boundary) = surface_of(&facets);
    let wanted = boundary_of_union(blocks);
    let extent_mm = surface.extent().into_iter().fold(0.0, f64::max) * surface.unit_m * 1e3;
    assert_distances(&surface, &boundary, 1e-9 * extent_mm, &|p| {
        distance_to(&wanted, &p)
    });
    // Faces in one plane are counted twice in the wall.
    if !coplanar {
        let (found, wanted) = (enclosed_mm3(&surface, &boundary), signed_volume(&wanted));
        assert!((found / wanted - 1.0).abs() < 1e-12, "{found} {wanted}");
    }
}

#[test]
fn of_two_boxes() {
    let first = block([0.0; 3], [10.0, 8.0, 6.0]);
    let second = block([7.0, 3.0, 2.0], [15.0, 13.0, 12.0]);
    assert_union_of_blocks(&[first, second], false);
    let (surface, boundary) = surface_of(&[first.facets(), second.facets()].concat());
    let wanted = 480.0 + 800.0 - 3.0 * 5.0 * 4.0;
    assert!((enclosed_mm3(&surface, &boundary) / wanted - 1.0).abs() < 1e-12);
    // Passing through completely, in both directions.
    let rod = block([-3.0, 2.0, 1.0], [20.0, 5.0, 4.0]);
    assert_union_of_blocks(&[first, rod], false);
    assert_union_of_blocks(&[rod, first], false);
}

#[test]
fn of_tilted_boxes() {
    let slanted = tilted([20.0, 0.0, 130.0], [195.0, 130.0, 260.0]);
    assert!((slanted.volume() / (195.0 * 130.0 * 260.0) - 1.0).abs() < 1e-12);
    let upright = block([0.0; 3], [150.0, 100.0, 300.0]);
    assert_union_of_blocks(&[slanted, upright], false);
    let other = tilted([50.0, -40.0, 90.0], [65.0, 260.0, 130.0]);
    assert_union_of_blocks(&[slanted, upright, other], false);
}

#[test]
fn of_boxes_with_faces_in_one_plane() {
    let first = block([0.0; 3], [4.0; 3]);
    for second in [
        // Four faces in the planes of others; edges on edges.
        block([2.0, 0.0, 0.0], [6.0, 4.0, 4.0]),
        // A common corner, and three common planes.
        block([0.0; 3], [2.0, 6.0, 8.0]),
        // One common plane.
        block([1.0, 1.0, 0.0], [6.0, 3.0, 3.0]),
        // From face to face, ending in them.
        block([1.0, 1.0, 0.0], [3.0, 3.0, 9.0]),
    ] {
        assert_union_of_blocks(&[first, second], true);
        assert_union_of_blocks(&[second, first], true);
    }
    assert_union_of_blocks(
        &[
            first,
            block([2.0, 0.0, 0.0], [6.0, 4.0, 4.0]),
            block([3.0, 2.0, 0.0], [5.0, 7.0, 4.0]),
        ],
        true,
    );
}

#[test]
fn faces_nearly_in_one_plane_leave_no_hole() {
    // Rotated and rounded to single precision, planes that coincided differ by rounding.
    let mut random = random_numbers(3);
    let blocks = [
        block([0.0; 3], [4.0; 3]),
        block([2.0, 0.0, 0.0], [6.0, 4.0, 4.0]),
        block([1.0, 1.0, 2.0], [3.0, 3.0, 9.0]),
    ];
    let facets: Facets = blocks.iter().flat_map(Block::facets).collect();
    for _ in 0..20 {
        let turned = turned(&mut random, facets.clone());
        // The reference is moved along with the same facets: three corners of the first box give
        // the motion.
        let moved = |p: Point| {
            let corner = |k: usize| turned[0][k];
            let from = blocks[0].facets()[0];
            let [u, v] = [1, 2].map(|k| (sub(from[k], from[0]), sub(corner(k), corner(0))));
            let across = (cross(u.0, v.0), cross(u.1, v.1));
            let w = (
                scaled(across.0, 1.0 / length(across.0)),
                scaled(across.1, 1.0 / length(across.1)),
            );
            let from_axes = nalgebra::Matrix3::from_columns(&[u.0, v.0, w.0].map(Vector3::from));
            let to_axes = nalgebra::Matrix3::from_columns(&[u.1, v.1, w.1].map(Vector3::from));
            let inverse = from_axes.try_inverse().unwrap();
            let q = to_axes * (inverse * Vector3::from(sub(p, from[0])));
            plus(corner(0), [q.x, q.y, q.z])
        };
        let wanted: Facets = boundary_of_union(&blocks)
            .into_iter()
            .map(|corners| corners.map(moved))
            .collect();
        let (surface, boundary) = surface_of(&turned);
        assert_distances(&surface, &boundary, 5e-5, &|p| distance_to(&wanted, &p));
    }
}

#[test]
fn boxes_that_only_touch_keep_the_wall_between_them() {
    // The third crosses the first, so that a union is formed.
    let blocks = [
        block([0.0; 3], [4.0; 3]),
        block([4.0, 1.0, 1.0], [8.0, 3.0, 3.0]),
        block([1.0, 1.0, 1.0], [2.0, 2.0, 9.0]),
    ];
    let facets: Facets = blocks.iter().flat_map(Block::facets).collect();
    let (surface, boundary) = surface_of(&facets);
    let wanted = boundary_of_union(&blocks);
    assert_distances(&surface, &boundary, 1e-8, &|p| distance_to(&wanted, &p));
}

#[test]
fn of_cavities_that_cross() {
    let outer = block([0.0; 3], [20.0; 3]);
    let cavities = [
        block([3.0, 4.0, 5.0], [11.0, 10.0, 12.0]),
        block([8.0, 7.0, 9.0], [16.0, 17.0, 15.0]),
    ];
    let mut facets = outer.facets();
    for cavity in &cavities {
        facets.extend(turned_inside_out(cavity.facets()));
    }
    let (surface, boundary) = surface_of(&facets);
    let void = 8.0 * 6.0 * 7.0 + 8.0 * 10.0 * 6.0 - 3.0 * 3.0 * 3.0;
    let found = enclosed_mm3(&surface, &boundary);
    assert!((found / (8000.0 - void) - 1.0).abs() < 1e-12, "{found}");
    let wanted = [outer.facets(), boundary_of_union(&cavities)].concat();
    assert_distances(&surface, &boundary, 2e-8, &|p| distance_to(&wanted, &p));
}

/// Balls of radius 10 whose facets lie at most this far from the sphere (mm).
const CHORD_MM: f64 = 0.08;

fn ball(middle: Point) -> Facets {
    icosphere(3, &|_| 10.0)
        .into_iter()
        .map(|corners| corners.map(|p| plus(p, middle).map(|x| f64::from(x as f32))))
        .collect()
}

#[test]
fn of_two_balls() {
    let apart = 13.0;
    let (surface, boundary) = surface_of(&[ball([0.0; 3]), ball([apart, 0.0, 0.0])].concat());
    // The common lens of two balls of radius r: pi (4 r + d) (2 r - d)^2 / 12.
    let lens = PI * (40.0 + apart) * (20.0 - apart).powi(2) / 12.0;
    let wanted = 8.0 / 3.0 * PI * 1000.0 - lens;
    let found = enclosed_mm3(&surface, &boundary);
    assert!(
        (found / wanted - 1.0).abs() < 3.0 * CHORD_MM / 10.0,
        "{found} {wanted}"
    );
    let error = (found - surface.volume_m3() * 1e9).abs();
    assert!(error <= surface.overlap_volume_error_m3 * 1e9, "{error}");
    // The nearest part is the circle where they meet, or the far side of one ball.
    let circle = (100.0 - 0.25 * apart * apart).sqrt();
    assert_distances(&surface, &boundary, 3.0 * CHORD_MM, &|[x, y, z]| {
        let from_axis = y.hypot(z);
        let to_circle = (x - 0.5 * apart).hypot(from_axis - circle);
        let to_ball = |middle: f64, sign: f64| {
            let r = (x - middle).hypot(from_axis);
            let there = middle + 10.0 * (x - middle) / r;
            if sign * (there - 0.5 * apart) >= 0.0 {
                10.0 - r
            } else {
                f64::INFINITY
            }
        };
        to_circle
            .min(to_ball(0.0, -1.0).abs())
            .min(to_ball(apart, 1.0).abs())
    });
}

#[test]
fn of_three_balls() {
    let middles = [[0.0; 3], [12.0, 1.0, 0.0], [5.0, 11.0, 2.0]];
    let facets: Facets = middles.iter().flat_map(|m| ball(*m)).collect();
    let (surface, boundary) = surface_of(&facets);
    let error = (enclosed_mm3(&surface, &boundary) - surface.volume_m3() * 1e9).abs();
    assert!(error <= surface.overlap_volume_error_m3 * 1e9, "{error}");
    // The facets' own corners, where no other ball covers them, are points of the boundary.
    let corners: Vec<Point> = facets
        .iter()
        .flatten()
        .copied()
        .filter(|p| middles.iter().all(|m| length(sub(*p, *m)) > 10.0 - 1e-4))
        .collect();
    // No facet has an edge longer than 1.1: no point of the boundary is farther from a corner of it
    // than about twice that.
    assert_distances(&surface, &boundary, 1.0, &|p| {
        let nearest = corners
            .iter()
            .map(|c| length(sub(*c, p)))
            .fold(f64::INFINITY, f64::min);
        nearest - 0.5
    });
}

#[test]
fn of_a_ball_and_a_box_with_large_faces() {
    // Hundreds of facets cross one.
    let facets = [
        block([-30.0, -25.0, -40.0], [30.0, 35.0, 3.0]).facets(),
        ball([1.0, 2.0, 5.0]),
    ];
    let (surface, boundary) = surface_of(&facets.concat());
    let found = enclosed_mm3(&surface, &boundary);
    let error = (found - surface.volume_m3() * 1e9).abs();
    assert!(error <= surface.overlap_volume_error_m3 * 1e9, "{error}");
    // The cap above the face: pi h^2 (3 r - h) / 3 with h = 12.
    let wanted = 60.0 * 60.0 * 43.0 + PI * 144.0 * 18.0 / 3.0;
    assert!((found / wanted - 1.0).abs() < 1e-3, "{found} {wanted}");
}

#[test]
fn of_random_solids_is_closed() {
    let mut random = random_numbers(7);
    for round in 0..36 {
        let [first, second] = [round % 6, round / 6].map(|kind| {
            let facets = random_solid(&mut random, kind).1;
            turned_about(&mut random, facets)
        });
        let (surface, boundary) = surface_of(&[first, second].concat());
        let wall = outer_pieces(&surface, boundary.facets());
        // Pieces narrower than 1e-7 remain on both sides of a crossing.
        assert!(gap(&wall) < 1e-7, "{round}: open by {:e}", gap(&wall));
        let volume = signed_volume(&wall) * surface.unit_m.powi(3);
        assert!(
            (volume - surface.volume_m3()).abs() <= surface.overlap_volume_error_m3 + 1e-9 * volume,
            "{round}: {volume} {} {}",
            surface.volume_m3(),
            surface.overlap_volume_error_m3
        );
    }
}

#[test]
fn of_a_solid_and_itself_hardly_moved_has_no_hole() {
    let mut random = random_numbers(8);
    for shift_mm in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        for kind in [0, 1, 2, 5] {
            let solid = random_solid(&mut random, kind).1;
            let way = point_between(&mut random, [-shift_mm; 3], [shift_mm; 3]);
            let moved = solid
                .iter()
                .map(|corners| corners.map(|p| plus(p, way).map(|x| f64::from(x as f32))));
            let (surface, boundary) = surface_of(&solid.iter().copied().chain(moved).collect());
            let mm =
                |p: Point| [0, 1, 2].map(|k| 1e3 * (surface.origin_m[k] + surface.unit_m * p[k]));
            let extent = surface.extent();
            for _ in 0..100 {
                let p = point_between(&mut random, [0.0; 3], extent);
                if winding_number(&solid, &mm(p)) == 1 {
                    let found = boundary.nearest(&Vector3::from(p), f64::MAX).unwrap();
                    let found = found.distance * surface.unit_m * 1e3;
                    let single = distance_to(&solid, &mm(p));
                    assert!(
                        found < single + 2.0 * shift_mm + 1e-5 && found > single - 1e-5,
                        "{kind} {shift_mm}: {found} {single}"
                    );
                }
            }
        }
    }
}
