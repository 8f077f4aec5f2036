//! The deepest point, compared with closed forms and random points; the first three spheres.

use crate::helpers::exact::winding_number;
use crate::helpers::facets::{Facets, cuboid};
use crate::helpers::solids::{
    between, distance_to_surface, icosphere, local_facets, point_between, random_numbers,
    surface_of, torus, turned, turned_inside_out,
};
use dem_pack::internals::{
    InscribedSphere, deepest_point, first_spheres, inner_points, spread_points,
};
use std::f64::consts::PI;

/// Radius in mm of the largest ball found. Checks that it is inside, and that no random point has a
/// larger one.
fn deepest_mm(facets: &Facets) -> f64 {
    let (surface, boundary) = surface_of(facets);
    let inner = inner_points(&boundary, &surface);
    let InscribedSphere { centre, radius } = deepest_point(&boundary, &surface, &inner).unwrap();
    let facets = local_facets(&surface);
    let centre = [centre.x, centre.y, centre.z];
    assert!(winding_number(&facets, &centre) > 0);
    assert!((distance_to_surface(&facets, &centre) / radius - 1.0).abs() < 1e-12);
    let mut random = random_numbers(1);
    for _ in 0..3000 {
        let p = point_between(&mut random, [0.0; 3], surface.extent());
        let depth = distance_to_surface(&facets, &p);
        assert!(
            depth < radius * (1.0 + 1e-6) || winding_number(&facets, &p) == 0,
            "{p:?} is deeper: {depth} {radius}"
        );
    }
    radius * surface.unit_m * 1e3
}

fn assert_near(value: f64, wanted: f64, relative: f64) {
    assert!((value / wanted - 1.0).abs() <= relative, "{value} {wanted}");
}

#[test]
fn of_a_box_half_the_smallest_edge() {
    let mut random = random_numbers(2);
    assert_near(deepest_mm(&cuboid([20.0, 12.0, 10.0])), 5.0, 1e-6);
    assert_near(deepest_mm(&cuboid([50.0, 50.0, 1.0])), 0.5, 1e-6);
    for _ in 0..6 {
        let size = [0; 3].map(|_| between(&mut random, 1.0, 30.0));
        let facets = cuboid(size);
        // With rounding: the far corner is in the first side wall's second triangle.
        let smallest = size
            .map(|s| f64::from(s as f32))
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        assert_near(deepest_mm(&facets), 0.5 * smallest, 1e-6);
        assert_near(
            deepest_mm(&turned(&mut random, facets)),
            0.5 * smallest,
            3e-6,
        );
    }
}

#[test]
fn of_a_ball_its_centre() {
    for times in [1, 2, 3] {
        let facets = icosphere(times, &|_| 10.0);
        let nearest = distance_to_surface(&facets, &[0.0; 3]);
        assert_near(deepest_mm(&facets), nearest, 1e-6);
    }
}

#[test]
fn of_a_torus_its_tube() {
    // The tube has radius 5 where its facets touch the torus, and deviates by less than the chords'
    // depths elsewhere.
    let (ring, tube) = (96.0, 48.0);
    let chords = 5.0 * (1.0 - (PI / tube).cos()) + 25.0 * (1.0 - (PI / ring).cos());
    let found = deepest_mm(&torus(20.0, 5.0, ring as usize, tube as usize));
    assert!((found - 5.0).abs() < chords, "{found}");
}

#[test]
fn of_a_hollow_ball_half_its_wall() {
    let mut facets = icosphere(3, &|_| 10.0);
    facets.extend(turned_inside_out(icosphere(3, &|_| 5.0)));
    let found = deepest_mm(&facets);
    let outer = distance_to_surface(&icosphere(3, &|_| 10.0), &[0.0; 3]);
    let inner = distance_to_surface(&icosphere(3, &|_| 5.0), &[0.0; 3]);
    assert!(
        found > 0.5 * (outer - 5.0) && found < 0.5 * (10.0 - inner),
        "{found}"
    );
}

#[test]
fn of_a_tetrahedron_its_inscribed_ball() {
    // Corner of a cube with edge a: r = a / (3 + sqrt 3).
    let a = 12.0;
    let [o, x, y, z] = [[0.0; 3], [a, 0.0, 0.0], [0.0, a, 0.0], [0.0, 0.0, a]];
    assert_near(
        deepest_mm(&vec![[o, y, x], [o, x, z], [x, y, z], [y, o, z]]),
        a / (3.0 + 3.0_f64.sqrt()),
        1e-6,
    );
}

#[test]
fn inner_points_lie_inside_and_know_their_depth_in_every_part() {
    let mut facets = icosphere(2, &|_| 4.0);
    facets.extend(
        cuboid([1.0, 1.0, 1.0])
            .into_iter()
            .map(|c| c.map(|p| [p[0] + 30.0, p[1], p[2]])),
    );
    let (surface, boundary) = surface_of(&facets);
    let facets = local_facets(&surface);
    let inner = inner_points(&boundary, &surface);
    assert!(
        inner
            .windows(2)
            .all(|pair| pair[0].radius >= pair[1].radius)
    );
    for ball in &inner {
        let centre = [ball.centre.x, ball.centre.y, ball.centre.z];
        assert!(winding_number(&facets, &centre) > 0);
        assert!((distance_to_surface(&facets, &centre) - ball.radius).abs() < 1e-12);
    }
    let in_small_part =
        |ball: &&InscribedSphere| surface.origin_m[0] + surface.unit_m * ball.centre.x > 20e-3;
    assert!(inner.iter().filter(in_small_part).count() >= 6);
}

#[test]
fn the_first_three_spheres_touch_each_other() {
    let mut random = random_numbers(5);
    for _ in 0..200 {
        let reduced = [0; 3].map(|_| between(&mut random, 0.2, 2.0));
        let centre =
            dem_pack::internals::Vector3::from(point_between(&mut random, [-5.0; 3], [5.0; 3]));
        let placed = first_spheres(&centre, reduced.map(|r| 1.25 * r), reduced, &|_, _| true);
        assert_eq!(placed.len(), 3);
        for (a, b) in [(0, 1), (0, 2), (1, 2)] {
            let distance = (placed[a].0 - placed[b].0).norm();
            assert_near(distance, reduced[a] + reduced[b], 1e-12);
        }
        assert_eq!([0, 1, 2].map(|k| placed[k].1), reduced.map(|r| 1.25 * r));
    }
}

#[test]
fn only_as_many_first_spheres_as_fit() {
    let centre = dem_pack::internals::Vector3::zeros();
    let one = first_spheres(&centre, [1.0; 3], [1.0; 3], &|p, _| p.norm() < 1e-9);
    assert_eq!(one.len(), 1);
    assert_eq!(
        first_spheres(&centre, [1.0; 3], [1.0; 3], &|_, _| false).len(),
        0
    );
    // A slab hardly thicker than a sphere: some of the orientations tried lie in it.
    let in_slab = first_spheres(&centre, [1.0; 3], [1.0; 3], &|p, _| p.z.abs() < 0.4);
    assert!(
        in_slab.len() >= 2 && in_slab.iter().all(|(p, _)| p.z.abs() < 0.4),
        "{in_slab:?}"
    );
}

#[test]
fn spread_points_keep_apart() {
    let points = spread_points(&[1.0, 0.7, 0.3], 0.1, 4);
    assert_eq!(points.len(), 10 * 7 * 3);
    for (i, p) in points.iter().enumerate() {
        assert!(points[i + 1..].iter().all(|q| (p - q).norm() > 0.1 / 3.0));
    }
}
