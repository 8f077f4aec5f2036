//! Surfaces as planes: those that are convex as seen from within.
//!
//! Before 4 July 2026, LAMMPS has no triangles for granular walls. A surface whose faces all look at
//! each other, such as a bin or a closed box, is the intersection of the half-spaces in front of
//! its faces.

use nalgebra::Vector3;

use dem_physics::geometry::frame::Frame;
use dem_physics::geometry::mesh::Mesh;
use dem_physics::geometry::one_surface::ALIKE;

/// Lengths below this fraction of the largest coordinate are rounding of the file: some ten times
/// that of 32-bit numbers.
const ROUNDING: f64 = 1e-6;
/// Directions count as parallel up to this sine.
const PARALLEL: f64 = 1e-5;
/// Largest number of faces: for each, LAMMPS keeps histories of all particles.
const MOST: usize = 200;

/// A point of a face, m, and its normal into the room, in space.
pub(super) type Face = [Vector3<f64>; 2];

type Triangle = [Vector3<f64>; 3];

/// The faces of a surface, one for each of its flat parts. `up`: against gravity; zero without it.
///
/// # Errors
/// Why it is not the boundary of what is in front of all of its faces.
pub(super) fn faces(mesh: &Mesh, frame: &Frame, up: Vector3<f64>) -> Result<Vec<Face>, String> {
    let to_space = |corner: [f64; 3]| Vector3::from(frame.to_space(corner));
    let triangles = mesh.corners_m().map(|corners| corners.map(to_space));
    let mut triangles: Vec<Triangle> = triangles.collect();
    let bounds = mesh.bounds();
    let coordinates = bounds.low.iter().chain(&bounds.high);
    let largest_m = coordinates.fold(mesh.diagonal_m(), |most, x| most.max(x.abs()));
    let small_m = ROUNDING * largest_m;
    let faces = flat_parts(&mut triangles, small_m)?;
    let is_behind =
        |corner: &Vector3<f64>| faces.iter().any(|face| depth_m(face, corner) < -small_m);
    if let Some(corner) = triangles.iter().flatten().find(|corner| is_behind(corner)) {
        let place = numbers_mm(corner);
        return Err(format!(
            "its faces do not all look at each other: the corner at {place} mm is behind one of them"
        ));
    }
    let alike = |one: usize| {
        faces[..one]
            .iter()
            .any(|[_, n]| n.dot(&faces[one][1]) > ALIKE)
    };
    if (0..faces.len()).any(alike) {
        return Err(
            "some of its faces meet at less than 8 degrees: near such an edge LAMMPS counts two contacts, and dem-run one"
                .to_owned(),
        );
    }
    match wrong_rim(&triangles, &faces, up, small_m) {
        Some(([from, to], why)) => {
            let [from, to] = [from, to].map(|corner| numbers_mm(&corner));
            Err(format!("at its rim from {from} to {to} mm {why}"))
        }
        None => Ok(faces),
    }
}

/// Distance in front of a face, m.
pub(super) fn depth_m([point, normal]: &Face, place: &Vector3<f64>) -> f64 {
    normal.dot(&(place - point))
}

fn numbers_mm(place: &Vector3<f64>) -> String {
    let numbers: [String; 3] = [0, 1, 2].map(|k| format!("{:.4}", 1e3 * place[k]));
    numbers.join(" ")
}

/// One face for all triangles in one plane, with its normal towards the middle of the surface.
fn flat_parts(triangles: &mut [Triangle], small_m: f64) -> Result<Vec<Face>, String> {
    let area = |corners: &Triangle| area_m2(corners).norm();
    let whole: f64 = triangles.iter().map(area).sum();
    let middles = triangles
        .iter()
        .map(|t| t.iter().sum::<Vector3<f64>>() * area(t));
    let middle = middles.sum::<Vector3<f64>>() / (3.0 * whole);
    // The normals of large triangles have the smallest errors.
    triangles.sort_by(|one, other| area(other).total_cmp(&area(one)));
    let mut faces: Vec<Face> = Vec::new();
    for corners in triangles.iter() {
        if faces.iter().any(|face| lies_in(corners, face, small_m)) {
            continue;
        }
        if faces.len() == MOST {
            return Err(format!("it has more than {MOST} faces"));
        }
        let normal = area_m2(corners).normalize();
        let towards = normal.dot(&(middle - corners[0]));
        if towards.abs() < small_m {
            return Err("it does not surround a room".to_owned());
        }
        faces.push([corners[0], normal * towards.signum()]);
    }
    Ok(faces)
}

fn lies_in(corners: &Triangle, face: &Face, small_m: f64) -> bool {
    corners.iter().all(|c| depth_m(face, c).abs() < small_m)
}

/// Twice the area of a triangle as a vector along its normal.
fn area_m2([a, b, c]: &Triangle) -> Vector3<f64> {
    (b - a).cross(&(c - a))
}

/// An edge of one triangle only, where the room that planes enclose is another than that of the
/// surface, and why: all that planes may do is go on upwards where the surface has ended.
fn wrong_rim(
    triangles: &[Triangle],
    faces: &[Face],
    up: Vector3<f64>,
    small_m: f64,
) -> Option<([Vector3<f64>; 2], &'static str)> {
    let why = |[from, to, third]: &Triangle| {
        let of = [*from, *to, *third];
        let [_, normal] = faces.iter().find(|face| lies_in(&of, face, small_m))?;
        let across = (to - from).cross(normal).normalize();
        let out = -across * across.dot(&(third - from)).signum();
        let reaches = |corner: &Vector3<f64>| out.dot(&(corner - from)) > small_m;
        let meets = |[_, n]: &Face| n.dot(&out) < -PARALLEL;
        if triangles.iter().flatten().any(reaches) || faces.iter().any(meets) {
            Some("it has a hole, a notch or a narrower outlet, which planes would close")
        } else if out.dot(&up) <= PARALLEL {
            Some("it is open, not upwards, and planes would go on")
        } else {
            None
        }
    };
    let edges = open_edges(triangles);
    edges
        .iter()
        .find_map(|edge| Some(([edge[0], edge[1]], why(edge)?)))
}

/// The edges of one triangle only, each with the third corner of that triangle.
fn open_edges(triangles: &[Triangle]) -> Vec<Triangle> {
    let name = |corner: &Vector3<f64>| [0, 1, 2].map(|k| (corner[k] + 0.0).to_bits());
    let key = |[from, to, _]: &Triangle| {
        let mut ends = [name(from), name(to)];
        ends.sort_unstable();
        ends
    };
    let edges = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]]);
    let mut edges: Vec<Triangle> = edges.collect();
    edges.sort_by_key(key);
    let same = edges.chunk_by(|one, other| key(one) == key(other));
    same.filter(|same| same.len() == 1)
        .map(|same| same[0])
        .collect()
}
