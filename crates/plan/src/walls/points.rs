//! Points on the surfaces of walls.

use std::f64::consts::TAU;

use dem_physics::geometry::{Bounds, Cylinder, Mesh, Shape};
use nalgebra::Vector3;

/// Pieces of an edge of a box.
const PIECES: usize = 8;
/// Rings of points along a cylinder, less one, and points on each of them.
const RINGS: usize = 16;
const ROUND: usize = 16;
/// Number of points on a mesh that is aimed at.
const ON_MESH: usize = 1000;

/// Points on the surface of a wall, in its own frame, m: its corners, and some on its edges and
/// faces; of a plane a single one.
pub(super) fn points_of(shape: &Shape) -> Vec<[f64; 3]> {
    match shape {
        Shape::Plane(plane) => vec![plane.point_m()],
        Shape::Box(solid) => points_of_box(&solid.bounds()),
        Shape::Cylinder(pin) => points_of_pin(pin),
        Shape::Mesh(mesh) => points_of_mesh(mesh),
    }
}

fn points_of_box(bounds: &Bounds) -> Vec<[f64; 3]> {
    let at = |k: usize, part: usize| {
        let share = part as f64 / PIECES as f64;
        bounds.low[k] + share * (bounds.high[k] - bounds.low[k])
    };
    let stops = PIECES + 1;
    let parts = (0..stops.pow(3)).map(|n| [n % stops, n / stops % stops, n / stops.pow(2)]);
    let is_outside = |parts: &[usize; 3]| parts.iter().any(|part| part % PIECES == 0);
    let outside = parts.filter(is_outside);
    outside
        .map(|parts| [0, 1, 2].map(|k| at(k, parts[k])))
        .collect()
}

fn points_of_pin(pin: &Cylinder) -> Vec<[f64; 3]> {
    let [from, to] = pin.ends_m().map(Vector3::from);
    let along = to - from;
    let across = along.cross(&Vector3::ith(along.iamin(), 1.0)).normalize();
    let other = along.normalize().cross(&across);
    let rings = (0..=RINGS).flat_map(|ring| {
        let centre = from + ring as f64 / RINGS as f64 * along;
        (0..ROUND).map(move |k| {
            let (sine, cosine) = (TAU * k as f64 / ROUND as f64).sin_cos();
            centre + pin.radius_m() * (cosine * across + sine * other)
        })
    });
    rings.chain([from, to]).map(Into::into).collect()
}

/// A grid on each triangle, or the corners of some of very many.
fn points_of_mesh(mesh: &Mesh) -> Vec<[f64; 3]> {
    let pieces = (ON_MESH / mesh.content.triangles).isqrt().max(1);
    let every = (3 * mesh.content.triangles).div_ceil(3 * ON_MESH);
    let share = 1.0 / pieces as f64;
    let mut points = Vec::new();
    for corners in mesh.corners_m().step_by(every) {
        for one in 0..=pieces {
            for two in 0..=pieces - one {
                let parts = [one, two, pieces - one - two].map(|part| share * part as f64);
                points.push([0, 1, 2].map(|k| (0..3).map(|n| parts[n] * corners[n][k]).sum()));
            }
        }
    }
    points
}
