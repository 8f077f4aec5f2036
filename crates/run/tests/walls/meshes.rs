//! Meshes are equivalent to the shapes that they represent.

use dem_physics::geometry::{Mesh, Plane, Shape, SolidBox, Touch};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

use super::{Surface, add_tiles, assert_same, box_surface, mesh, touches};

/// Squares of 1/8 on z = 0 between -1 and 1; vertices inside are moved within the plane.
fn tiled_plane(jitter: &[f64]) -> Surface {
    let mut surface = (Vec::new(), Vec::new());
    add_tiles(&mut surface, 16, |i, j| {
        let inner = (1..16).contains(&i) && (1..16).contains(&j);
        let move_by = |k: u32| {
            let at = (2 * (17 * i + j) + k) as usize % jitter.len();
            if inner { jitter[at] / 32.0 } else { 0.0 }
        };
        let at = |i: u32| f64::from(i) / 8.0 - 1.0;
        [at(i) + move_by(0), at(j) + move_by(1), 0.0]
    });
    surface
}

/// The only contact of a shape.
#[track_caller]
fn only(shape: &Shape, centre: [f64; 3], reach: f64) -> Touch {
    let found = touches(shape, centre, reach);
    assert_eq!(found.len(), 1, "{centre:?}: {found:?}");
    found[0]
}

fn turned(surface: &Surface, by: &Rotation3<f64>) -> Surface {
    let turn = |v: &[f64; 3]| (by * Vector3::from(*v)).into();
    (surface.0.iter().map(turn).collect(), surface.1.clone())
}

/// Distances from an edge or a vertex at which rounding matters.
const NEAR: [f64; 12] = [
    0.0, 1e-17, 1e-16, 1e-15, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 3e-9, 1e-8, 1e-6,
];

proptest! {
    /// Anywhere, over vertices, over edges, next to either, and on the surface.
    #[test]
    fn a_tiled_plane_is_a_plane(
        jitter in prop::collection::vec(-1.0..1.0_f64, 97),
        angles in prop::array::uniform3(-3.0..3.0_f64),
        places in prop::collection::vec((-0.7..0.7_f64, -0.7..0.7_f64, 0.0..0.4_f64), 20),
    ) {
        let [a, b, c] = angles;
        let by = Rotation3::from_euler_angles(a, b, c);
        let flat = tiled_plane(&jitter);
        let surface = turned(&flat, &by);
        let tiles = mesh(&surface);
        prop_assert_eq!(tiles.content.flat_parts, 1);
        prop_assert_eq!(tiles.content.straight_edges, 4);
        prop_assert_eq!(tiles.content.corners, 4);
        prop_assert_eq!(tiles.content.open_edges, 64);
        let tiles = Shape::Mesh(tiles);
        let up: [f64; 3] = (by * Vector3::z()).into();
        let plane = Shape::Plane(Plane::new([0.0; 3], up).unwrap());
        let mut feet: Vec<Vector3<f64>> = Vec::new();
        for (i, (x, y, _)) in places.iter().enumerate() {
            feet.push(Vector3::new(*x, *y, 0.0));
            let near = NEAR[i % NEAR.len()];
            let triangle = flat.1[(7 * i + 100) % flat.1.len()];
            let [p, q] = [0, 1].map(|k| Vector3::from(flat.0[triangle[k] as usize]));
            let step = Vector3::new(*y, *x + 1.0, 0.0).normalize() * near;
            feet.push(p + step);
            feet.push(p.lerp(&q, 0.5 * (x + 1.0)) + step);
            feet.push(p.lerp(&q, near) + step);
        }
        for (i, foot) in feet.into_iter().enumerate() {
            if foot.amax() > 0.8 {
                continue;
            }
            let height = [places[i % 20].2, 1e-3, 1e-9][i % 3];
            let centre: [f64; 3] = (by * (foot + height * Vector3::z())).into();
            let reach = height + 0.01;
            let found = only(&tiles, centre, reach);
            assert_same(&found, &only(&plane, centre, reach), 1e-12, "tiles");
            prop_assert_eq!(found.feature, 0);
        }
    }

    /// Outside, with a reach much larger than the box or so small that it excludes the rear.
    #[test]
    fn a_mesh_of_a_box_is_a_box(
        n in 1_u32..5,
        centre in prop::array::uniform3(prop_oneof![
            4 => -1.0..1.5_f64,
            1 => Just(0.0), 1 => Just(0.5), 1 => Just(0.25), 1 => Just(1e-9), 1 => Just(0.5 - 1e-12),
        ]),
        reach in 0.1..4.0_f64,
    ) {
        let (low, high) = ([0.0; 3], [0.5, 0.625, 0.75]);
        let solid = Shape::Box(SolidBox::new(low, high).unwrap());
        let surface = mesh(&box_surface(low, high, n));
        prop_assert_eq!(
            [surface.content.flat_parts, surface.content.straight_edges, surface.content.corners],
            [6, 12, 8]
        );
        prop_assert_eq!(surface.content.open_edges, 0);
        let wanted = touches(&solid, centre, reach);
        if wanted.iter().all(|touch| touch.distance_m > 1e-6) {
            let found = touches(&Shape::Mesh(surface), centre, reach);
            prop_assert_eq!(found.len(), wanted.len(), "{:?} {:?}", found, wanted);
            for (found, wanted) in found.iter().zip(&wanted) {
                // On an edge, and next to a vertex of its tiles within the tolerance, the point may
                // be displaced along it.
                let is_on_face = wanted.normal.iter().filter(|x| **x != 0.0).count() == 1;
                let error = if is_on_face { 1e-12 } else { 5e-8 * reach };
                assert_same(found, wanted, error, "box");
                prop_assert!((found.distance_m - wanted.distance_m).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn a_mesh_pushes_to_the_side_of_the_centre() {
    let tiles = Shape::Mesh(mesh(&tiled_plane(&[0.0])));
    for z in [0.1, -0.1] {
        let touch = only(&tiles, [0.3, 0.2, z], 0.2);
        assert_eq!(touch.normal, [0.0, 0.0, -z.signum()]);
    }
    let on_it = only(&tiles, [0.3, 0.2, 0.0], 0.2);
    assert_eq!((on_it.distance_m, on_it.normal[2].abs()), (0.0, 1.0));
}

#[test]
fn inside_a_corner_every_side_is_touched() {
    let inside = Shape::Mesh(mesh(&box_surface([0.0; 3], [1.0; 3], 3)));
    let count = |p: [f64; 3]| touches(&inside, p, 0.11).len();
    assert_eq!(count([0.1, 0.1, 0.1]), 3);
    assert_eq!(count([0.1, 0.1, 0.5]), 2);
    assert_eq!(count([0.1, 0.9, 0.9]), 3);
    assert_eq!(count([0.1, 0.5, 0.5]), 1);
    assert_eq!(count([0.5, 0.5, 0.5]), 0);
    for touch in touches(&inside, [0.1, 0.1, 0.1], 0.11) {
        assert!((touch.distance_m - 0.1).abs() < 1e-15, "{touch:?}");
        assert!((touch.normal.iter().sum::<f64>() + 1.0).abs() < 1e-15);
    }
}

#[test]
fn over_an_edge_or_corner_from_outside_there_is_one_touch() {
    let shape = Shape::Mesh(mesh(&box_surface([0.0; 3], [1.0; 3], 3)));
    for near in NEAR {
        // Outside by this distance, and inside the edges of the top by the same.
        for x in [1.0 + near, 1.0 - near] {
            only(&shape, [x, 0.4, 1.1], 0.2);
            only(&shape, [x, x, 1.1], 0.2);
            only(&shape, [x, 1.0 / 3.0, 1.1], 0.2);
        }
    }
    let touch = only(&shape, [1.3, 0.4, 1.4], 1.0);
    assert!((touch.distance_m - 0.5).abs() < 1e-15);
    let touch = only(&shape, [1.2, 1.3, 1.6], 1.0);
    assert!((touch.distance_m - 0.7).abs() < 1e-15);
}

#[test]
fn the_feature_stays_while_a_sphere_slides_over_it() {
    let shape = Shape::Mesh(mesh(&box_surface([0.0; 3], [1.0; 3], 5)));
    let along = |from: [f64; 3], to: [f64; 3]| {
        let mut features: Vec<u32> = (1..1000)
            .map(|i| {
                let at = Vector3::from(from).lerp(&Vector3::from(to), f64::from(i) / 1000.0);
                only(&shape, at.into(), 0.3).feature
            })
            .collect();
        features.dedup();
        features
    };
    // Over the top, along an edge (outside it), and from the top over an edge to the side.
    assert_eq!(along([0.0, 0.03, 1.1], [1.0, 0.97, 1.1]).len(), 1);
    assert_eq!(along([1.1, 0.0, 1.1], [1.1, 1.0, 1.1]).len(), 1);
    assert_eq!(along([0.9, 0.5, 1.15], [1.15, 0.5, 0.9]).len(), 3);
    assert_eq!(along([0.5, 1.1, 1.1], [1.2, 1.1, 1.1]).len(), 2);
}

/// Tiles that share no vertices where they meet, and two plates on top of each other.
#[test]
fn triangles_need_not_share_vertices() {
    let vertices = vec![
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 0.5, 0.0],
        [1.0, 0.5, 0.0],
        [1.0, 0.5, 0.0],
        [2.0, 0.5, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.2, 0.2, 0.0],
        [1.5, 0.2, 0.0],
        [1.5, 0.8, 0.0],
        [0.2, 0.8, 0.0],
    ];
    let triangles: Vec<[u32; 3]> = (0..4)
        .flat_map(|i| [[4 * i, 4 * i + 1, 4 * i + 2], [4 * i, 4 * i + 2, 4 * i + 3]])
        .collect();
    let shape = Shape::Mesh(Mesh::new(&vertices, &triangles).unwrap());
    for i in 1..40 {
        for j in 1..20 {
            let touch = only(&shape, [f64::from(i) / 20.0, f64::from(j) / 20.0, 0.3], 0.5);
            assert!((touch.distance_m - 0.3).abs() < 1e-15);
        }
    }
}

/// Single-precision coordinates of an STL, rotated: faces are not quite flat.
#[test]
fn single_precision_costs_no_second_touch() {
    let by = Rotation3::from_euler_angles(0.3, 0.8, -1.1);
    let mut surface = turned(&tiled_plane(&[0.3, -0.8, 0.5]), &by);
    for x in surface.0.iter_mut().flatten() {
        *x = f64::from((1000.0 * *x) as f32) / 1000.0;
    }
    let tiles = mesh(&surface);
    assert_eq!(tiles.content.flat_parts, 1);
    let shape = Shape::Mesh(tiles);
    for i in 0..4000 {
        let t = f64::from(i) / 4000.0;
        let place = Vector3::new(1.6 * t - 0.8, 0.8 * (9.0 * t).sin(), 0.2);
        let touch = only(&shape, (by * place).into(), 0.3);
        assert!((touch.distance_m - 0.2).abs() < 1e-6);
        assert_eq!(touch.feature, 0);
    }
}

/// A rim that rounding has bent inwards in the middle: both halves are nearer to a sphere in front
/// of it than the vertex between them.
#[test]
fn a_bent_straight_edge_is_touched_once() {
    let vertices = [
        [0.0, 0.0, 0.0],
        [1.0, -1e-7, 0.0],
        [2.0, 0.0, 0.0],
        [1.0, -2.0, 0.0],
    ];
    let plate = Shape::Mesh(Mesh::new(&vertices, &[[0, 1, 3], [1, 2, 3]]).unwrap());
    for x in [0.5, 1.0, 1.5] {
        only(&plate, [x, 0.3, 0.0], 0.4);
    }
    let feature = |x| only(&plate, [x, 0.3, 0.0], 0.4).feature;
    assert_eq!(feature(0.5), feature(1.5));
}

/// A drum of 90 flat strips, with a sphere rolling inside: always exactly one contact.
#[test]
fn a_round_hollow_pushes_once() {
    let mut surface = (Vec::new(), Vec::new());
    let corner = |i: u32, y: f64| {
        let angle = std::f64::consts::TAU * f64::from(i % 90) / 90.0;
        [angle.cos(), y, angle.sin()]
    };
    for i in 0..90 {
        let first = surface.0.len() as u32;
        surface.0.extend([
            corner(i, -1.0),
            corner(i, 1.0),
            corner(i + 1, -1.0),
            corner(i + 1, 1.0),
        ]);
        surface.1.extend([
            [first, first + 1, first + 2],
            [first + 2, first + 1, first + 3],
        ]);
    }
    let drum = Shape::Mesh(mesh(&surface));
    for i in 0..3000 {
        let angle = 0.01 * f64::from(i);
        let touch = only(&drum, [0.8 * angle.cos(), 0.1, 0.8 * angle.sin()], 0.21);
        assert!((0.199..0.2001).contains(&touch.distance_m), "{touch:?}");
    }
}

#[test]
fn a_thin_plate_is_touched_on_one_side() {
    let plate = Shape::Mesh(mesh(&box_surface([0.0; 3], [1.0, 1.0, 0.01], 2)));
    assert!((only(&plate, [0.4, 0.4, 0.2], 0.5).distance_m - 0.19).abs() < 1e-15);
}

/// A plate without the middle one of its nine squares. Its rim has two edges at every corner, in
/// one flat part.
#[test]
fn over_a_hole_the_rim_is_touched() {
    let mut surface = (Vec::new(), Vec::new());
    add_tiles(&mut surface, 3, |i, j| [f64::from(i), f64::from(j), 0.0]);
    surface.1.drain(8..10);
    let plate = mesh(&surface);
    let content = plate.content;
    assert_eq!(
        (content.flat_parts, content.straight_edges, content.corners),
        (1, 8, 8)
    );
    let shape = Shape::Mesh(plate);
    let count = |p: [f64; 3], reach: f64| touches(&shape, p, reach).len();
    assert_eq!(count([1.5, 1.5, 0.1], 0.52), 4);
    assert_eq!(count([1.5, 1.5, 0.1], 0.5), 0);
    assert_eq!(count([1.2, 1.3, 0.1], 0.35), 2);
    assert_eq!(count([1.0, 1.5, 0.1], 0.35), 1);
    assert_eq!(count([1.0, 1.0, 0.1], 0.35), 1);
    assert_eq!(count([0.9, 0.9, 0.1], 0.35), 1);
    assert_eq!(count([3.1, 3.1, 0.1], 0.35), 1);
    let rolling: Vec<u32> = (0..300)
        .map(|i| only(&shape, [1.2, 1.3 + 0.4 * f64::from(i) / 299.0, 0.5], 0.54).feature)
        .collect();
    assert!(rolling.iter().all(|feature| *feature == rolling[0]));
}

/// A plate modelled with two sides.
#[test]
fn facets_that_stand_there_both_ways_are_touched_once() {
    let mut surface = tiled_plane(&[0.0]);
    let turned: Vec<[u32; 3]> = surface.1.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    surface.1.extend(turned);
    let shape = Shape::Mesh(mesh(&surface));
    for x in [-0.5, 0.01, 0.125, 1.01] {
        for z in [-0.1, 0.1] {
            only(&shape, [x, 0.3, z], 0.2);
        }
    }
}

#[test]
fn meshes_without_sense_are_refused_and_triangles_without_area_dropped() {
    let square = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.5, 0.0, 0.0]];
    let with_slivers = Mesh::new(&square, &[[0, 1, 2], [0, 1, 3], [1, 1, 2]]).unwrap();
    assert_eq!(
        (
            with_slivers.content.triangles,
            with_slivers.content.degenerate
        ),
        (1, 2)
    );
    assert!((with_slivers.diagonal_m() - 2.0_f64.sqrt()).abs() < 1e-15);
    assert_eq!(Shape::Mesh(with_slivers).bounds().high, [1.0, 1.0, 0.0]);
    for (vertices, triangles) in [
        (square.clone(), vec![]),
        (square.clone(), vec![[0, 1, 3]]),
        (square.clone(), vec![[0, 1, 4]]),
        (
            vec![[0.0; 3], [1.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0]],
            vec![[0, 1, 2]],
        ),
    ] {
        let error = Mesh::new(&vertices, &triangles).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{error}");
    }
}
