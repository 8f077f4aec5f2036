//! Planes, boxes and cylinders.

use dem_physics::geometry::{Cylinder, Plane, Shape, SolidBox};
use nalgebra::Vector3;
use proptest::prelude::*;

use super::{apart, touches};

/// True if a point is inside, and its distance from the surface, by the textbook formula (negative
/// inside).
fn box_distance(p: [f64; 3], half: [f64; 3]) -> f64 {
    let q = [0, 1, 2].map(|k| p[k].abs() - half[k]);
    let outside = Vector3::from(q.map(|x| x.max(0.0))).norm();
    outside + q.into_iter().fold(f64::NEG_INFINITY, f64::max).min(0.0)
}

fn cylinder_distance(p: [f64; 3], half: f64, radius: f64) -> f64 {
    let [x, y, z] = p;
    let q = [x.hypot(y) - radius, z.abs() - half];
    q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0)
}

/// Conditions for every contact of a solid: the point matches the normal and the distance, and lies
/// on the surface.
fn assert_touch(shape: &Shape, p: [f64; 3], distance: f64, surface: impl Fn([f64; 3]) -> f64) {
    let found = touches(shape, p, 100.0);
    assert_eq!(found.len(), 1, "{p:?}");
    let touch = found[0];
    let normal = Vector3::from(touch.normal);
    assert!((normal.norm() - 1.0).abs() < 1e-14, "{p:?}: {touch:?}");
    assert!(
        (touch.distance_m - distance).abs() < 1e-14,
        "{p:?}: {touch:?}, {distance}"
    );
    let there = Vector3::from(p) + touch.distance_m * normal;
    assert!(apart(there.into(), touch.point) < 1e-14, "{p:?}: {touch:?}");
    assert!(surface(touch.point).abs() < 1e-14, "{p:?}: {touch:?}");
    // One step along the normal goes into the wall, or along a face from its edge.
    let deeper = surface((Vector3::from(touch.point) + 1e-6 * normal).into());
    assert!(deeper < 1e-14, "{p:?}: {touch:?} leads out");
    assert!(touches(shape, p, distance - 1e-12).is_empty());
    assert_eq!(touches(shape, p, distance + 1e-12).len(), 1);
}

/// Coordinates with many equal values: over faces, edges, corners and exactly on them.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![-2.0..2.0, Just(-0.5), Just(0.75), Just(0.0), Just(1.0)]
}

proptest! {
    #[test]
    fn a_box_is_where_the_formula_says(p in prop::array::uniform3(coordinate())) {
        let half = [0.5, 0.75, 1.0];
        let shape = Shape::Box(SolidBox::new(half.map(|x| -x), half).unwrap());
        assert_touch(&shape, p, box_distance(p, half), |q| box_distance(q, half));
    }

    #[test]
    fn a_cylinder_is_where_the_formula_says(p in prop::array::uniform3(coordinate())) {
        let shape = Shape::Cylinder(Cylinder::new([[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]], 0.75).unwrap());
        assert_touch(&shape, p, cylinder_distance(p, 0.5, 0.75), |q| cylinder_distance(q, 0.5, 0.75));
    }

    #[test]
    fn a_plane_is_solid_behind(p in prop::array::uniform3(coordinate())) {
        let shape = Shape::Plane(Plane::new([0.0, 0.0, 0.25], [0.0, 0.0, 3.0]).unwrap());
        assert_touch(&shape, p, p[2] - 0.25, |q| q[2] - 0.25);
    }
}

#[test]
fn features_of_solids_tell_the_side() {
    let shape = Shape::Box(SolidBox::new([0.0; 3], [1.0; 3]).unwrap());
    let feature = |p| touches(&shape, p, 9.0)[0].feature;
    assert_eq!(feature([0.3, 0.4, 1.2]), feature([0.9, 0.1, 1.001]));
    assert_eq!(feature([0.3, 0.4, 1.2]), feature([0.3, 0.4, 0.9]));
    assert_eq!(feature([0.3, 1.4, 1.2]), feature([0.8, 3.4, 1.1]));
    let mut all: Vec<u32> = Vec::new();
    for x in [-0.5, 0.5, 1.5] {
        for y in [-0.5, 0.5, 1.5] {
            for z in [-0.5, 0.5, 1.5] {
                all.push(feature([x, y, z]));
            }
        }
    }
    all.sort_unstable();
    all.dedup();
    // The middle is inside, under one of the faces.
    assert_eq!(all.len(), 26);

    let shape = Shape::Cylinder(Cylinder::new([[0.0; 3], [2.0, 0.0, 0.0]], 1.0).unwrap());
    let places = [
        [1.0, 2.0, 0.0],
        [-1.0, 0.0, 0.0],
        [3.0, 0.5, 0.0],
        [-1.0, 0.0, 2.0],
        [3.0, 0.0, 2.0],
    ];
    let found = places.map(|p| touches(&shape, p, 9.0)[0].feature);
    assert_eq!(found, [0, 1, 2, 3, 4]);
    let inside = [[1.0, 0.9, 0.0], [0.1, 0.0, 0.0], [1.9, 0.5, 0.0]];
    assert_eq!(
        inside.map(|p| touches(&shape, p, 9.0)[0].feature),
        [0, 1, 2]
    );
}

#[test]
fn a_cylinder_that_lies_askew_has_a_tight_box() {
    let ends = [[1.0, 2.0, 3.0], [2.0, 4.0, 5.0]];
    let cylinder = Cylinder::new(ends, 0.6).unwrap();
    let bounds = Shape::Cylinder(cylinder).bounds();
    // Axis (1, 2, 2)/3.
    for (k, axis) in [1.0, 2.0, 2.0].into_iter().enumerate() {
        let half = 0.6 * (1.0_f64 - axis * axis / 9.0).sqrt();
        assert!((bounds.low[k] - (ends[0][k] - half)).abs() < 1e-14);
        assert!((bounds.high[k] - (ends[1][k] + half)).abs() < 1e-14);
    }
}

#[test]
fn shapes_without_sense_are_refused() {
    let said = [
        Plane::new([0.0; 3], [0.0; 3]).unwrap_err(),
        Plane::new([f64::NAN, 0.0, 0.0], [1.0; 3]).unwrap_err(),
        SolidBox::new([0.0; 3], [1.0, 0.0, 1.0]).unwrap_err(),
        SolidBox::new([0.0; 3], [1.0, f64::INFINITY, 1.0]).unwrap_err(),
        SolidBox::new([0.0; 3], [1.0, f64::NAN, 1.0]).unwrap_err(),
        Cylinder::new([[0.0; 3], [0.0; 3]], 1.0).unwrap_err(),
        Cylinder::new([[0.0; 3], [1.0; 3]], 0.0).unwrap_err(),
        Cylinder::new([[0.0; 3], [1.0; 3]], f64::NAN).unwrap_err(),
    ];
    for error in said {
        assert_eq!(error.exit_code(), 2, "{error}");
        assert!(!error.remedy.is_empty());
    }
}
