//! Objects thrown at a packed body from any direction and in any orientation first touch a sphere
//! of its outer layer: balls, planes, edges and corners of cubes.

use std::path::Path;

use dem_physics::shape::outer_layer::{HIDDEN, outer_layer};
use nalgebra::{UnitQuaternion, Vector3};

use dem_testing::Random;

/// Radius of the ball as a fraction of the smallest radius.
const BALL: f64 = 0.7;

struct Packed {
    centres: Vec<Vector3<f64>>,
    radii: Vec<f64>,
    is_outer: Vec<bool>,
    smallest: f64,
}

/// A cake of 493 spheres, with pores between them.
fn cake(ball: f64) -> Packed {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/bodies/cake.vtp");
    let body = dem_io::body::read_body(Path::new(path)).unwrap();
    let smallest = body.radii.iter().copied().fold(f64::INFINITY, f64::min);
    let outer = outer_layer(&body.positions, &body.radii, HIDDEN, ball * smallest);
    let mut is_outer = vec![false; body.radii.len()];
    for i in outer {
        is_outer[i as usize] = true;
    }
    Packed {
        centres: body.positions.iter().map(|p| Vector3::from(*p)).collect(),
        radii: body.radii,
        is_outer,
        smallest,
    }
}

impl Packed {
    fn outer(&self) -> usize {
        self.is_outer.iter().filter(|outer| **outer).count()
    }

    /// The sphere that an object flying towards the middle touches first. `distance`: distance of a
    /// point from the object at its starting position.
    fn first(&self, direction: &Vector3<f64>, distance: impl Fn(Vector3<f64>) -> f64) -> usize {
        let mut gone = 0.0;
        loop {
            // A move by the smallest gap cannot pass any sphere.
            let (nearest, gap) = (self.centres.iter().zip(&self.radii).enumerate())
                .map(|(i, (c, r))| (i, distance(c - gone * direction) - r))
                .min_by(|a, b| a.1.total_cmp(&b.1))
                .unwrap();
            if gap < 1e-10 * self.smallest {
                return nearest;
            }
            gone += gap;
            assert!(gone < 1.0, "it passes by");
        }
    }
}

/// A start on a sphere around the body, and the direction to a point within it.
fn throw(packed: &Packed, random: &mut Random) -> (Vector3<f64>, Vector3<f64>) {
    let from = 0.3 * random.direction();
    let target = packed.centres[random.bits() as usize % packed.centres.len()];
    (from, (target - from).normalize())
}

/// Distance from the octant of space where all three coordinates are positive.
fn from_octant(p: Vector3<f64>) -> f64 {
    let out = p.map(|x| (-x).max(0.0));
    out.norm()
}

/// Distance from the wedge of space where two are positive.
fn from_wedge(p: Vector3<f64>) -> f64 {
    from_octant(Vector3::new(p.x, p.y, 1.0))
}

#[test]
fn a_third_of_a_cake_lies_within() {
    let (all, packed) = (cake(0.0), cake(BALL));
    println!(
        "{} of {}, {}",
        packed.outer(),
        packed.radii.len(),
        all.outer()
    );
    assert!(all.outer() == 493 && packed.outer() < 350);
    // Smaller balls reach farther in, larger ones less far, until corners are too far from them.
    let counts = [0.1, 0.2, 0.3, 0.5].map(|ball| cake(ball).outer());
    assert!(counts.is_sorted_by(|a, b| a >= b), "{counts:?}");
}

#[test]
fn balls_edges_and_corners_touch_the_outer_layer_first() {
    let packed = cake(BALL);
    let mut random = Random(35);
    let mut touched = vec![false; packed.radii.len()];
    for n in 0..40_000 {
        let (from, direction) = throw(&packed, &mut random);
        let turned: UnitQuaternion<f64> = random.rotation();
        let ball = BALL * packed.smallest * [1.0, 1.3, 3.0][n / 4 % 3];
        let seen = |p: Vector3<f64>| turned.inverse_transform_vector(&(p - from));
        let first = match n % 4 {
            0 => packed.first(&direction, |p| (p - from).norm() - ball),
            // A corner pointing forwards, more or less.
            1 => {
                let ahead = turned * Vector3::repeat(-1.0);
                if ahead.dot(&direction) < 0.5 {
                    continue;
                }
                packed.first(&direction, |p| from_octant(seen(p)))
            }
            2 => {
                let ahead = turned * Vector3::new(-1.0, -1.0, 0.0);
                if ahead.dot(&direction) < 0.5 {
                    continue;
                }
                packed.first(&direction, |p| from_wedge(seen(p)))
            }
            _ => packed.first(&direction, |p| (p - from).dot(&direction)),
        };
        touched[first] = true;
        assert!(packed.is_outer[first], "{n}: sphere {first}");
    }
    let count = touched.iter().filter(|t| **t).count();
    println!("{count} of {} outer spheres were touched", packed.outer());
    assert!(count > 250, "{count}");
}

/// Objects sharper than a cube, or smaller than the balls, do reach inside: for them the layer
/// contains everything that is not covered.
#[test]
fn needles_touch_spheres_within() {
    let packed = cake(BALL);
    let mut random = Random(36);
    let inner = (0..20_000).filter(|_| {
        let (from, direction) = throw(&packed, &mut random);
        !packed.is_outer[packed.first(&direction, |p| (p - from).norm())]
    });
    assert!(inner.count() > 10);
}
