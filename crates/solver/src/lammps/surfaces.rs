//! Surfaces as planes: those that are convex as seen from within.
//!
//! LAMMPS has no triangles for granular walls. A surface whose faces all look at each other, such
//! as a bin, a drum or a closed box, is the intersection of the half-spaces in front of its faces.

use nalgebra::Vector3;

use crate::geometry::frame::Frame;
use crate::geometry::mesh::Mesh;

/// Lengths below this fraction of the diagonal are rounding of the file.
const ROUNDING: f64 = 1e-5;
/// Largest number of faces: LAMMPS asks each particle for every one of them.
const MOST: usize = 1000;

/// A point of a face, m, and its normal into the room, in space.
pub(super) type Face = [Vector3<f64>; 2];

/// The faces of a surface, one for each of its flat parts.
///
/// # Errors
/// Why it is not the boundary of what is in front of all of its faces.
pub(super) fn faces(mesh: &Mesh, frame: &Frame) -> Result<Vec<Face>, String> {
    let to_space = |corner: [f64; 3]| Vector3::from(frame.to_space(corner));
    let triangles = mesh.corners_m().map(|corners| corners.map(to_space));
    let mut triangles: Vec<[Vector3<f64>; 3]> = triangles.collect();
    let small_m = ROUNDING * mesh.diagonal_m();
    let faces = flat_parts(&mut triangles, small_m)?;
    let is_behind =
        |corner: &Vector3<f64>| faces.iter().any(|face| depth_m(face, corner) < -small_m);
    if let Some(corner) = triangles.iter().flatten().find(|corner| is_behind(corner)) {
        let place = numbers_mm(corner);
        return Err(format!(
            "its faces do not all look at each other: the corner at {place} mm is behind one of them"
        ));
    }
    if let Some([from, to]) = narrowing_rim(&triangles, &faces) {
        let [from, to] = [from, to].map(|corner| numbers_mm(&corner));
        return Err(format!(
            "it is open and becomes narrower towards its rim from {from} to {to} mm, where planes would close it"
        ));
    }
    Ok(faces)
}

/// Distance in front of a face, m.
pub(super) fn depth_m([point, normal]: &Face, place: &Vector3<f64>) -> f64 {
    normal.dot(&(place - point))
}

fn numbers_mm(place: &Vector3<f64>) -> String {
    let numbers: [String; 3] = [0, 1, 2].map(|k| format!("{:.4}", 1e3 * place[k]));
    numbers.join(" ")
}

/// One face for all triangles in one plane, with its normal towards the middle of all corners.
fn flat_parts(triangles: &mut [[Vector3<f64>; 3]], small_m: f64) -> Result<Vec<Face>, String> {
    let corners = triangles.iter().flatten();
    let middle = corners.sum::<Vector3<f64>>() / (3 * triangles.len()) as f64;
    // The normals of large triangles have the smallest errors.
    triangles.sort_by(|one, other| area_m2(other).norm().total_cmp(&area_m2(one).norm()));
    let mut faces: Vec<Face> = Vec::new();
    for corners in triangles.iter() {
        let lies_in = |face: &Face| corners.iter().all(|c| depth_m(face, c).abs() < small_m);
        if faces.iter().any(lies_in) {
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

/// Twice the area of a triangle as a vector along its normal.
fn area_m2([a, b, c]: &[Vector3<f64>; 3]) -> Vector3<f64> {
    (b - a).cross(&(c - a))
}

/// An edge of one triangle only, from which on this triangle, going on beyond it, would come nearer
/// to another face.
fn narrowing_rim(triangles: &[[Vector3<f64>; 3]], faces: &[Face]) -> Option<[Vector3<f64>; 2]> {
    let name = |corner: &Vector3<f64>| [0, 1, 2].map(|k| (corner[k] + 0.0).to_bits());
    let edges = triangles
        .iter()
        .flat_map(|[a, b, c]| [[*a, *b, *c], [*b, *c, *a], [*c, *a, *b]]);
    let key = |[from, to, _]: &[Vector3<f64>; 3]| {
        let mut ends = [name(from), name(to)];
        ends.sort_unstable();
        ends
    };
    let mut edges: Vec<[Vector3<f64>; 3]> = edges.collect();
    edges.sort_by_key(key);
    let of_one = edges.chunk_by(|one, other| key(one) == key(other));
    let mut rim = of_one.filter(|same| same.len() == 1).map(|same| same[0]);
    let narrows = |[from, to, third]: &[Vector3<f64>; 3]| {
        let along = (to - from).normalize();
        let out = from - third - along * along.dot(&(from - third));
        let out = out.normalize();
        faces.iter().any(|[_, normal]| normal.dot(&out) < -ROUNDING)
    };
    rim.find(narrows).map(|[from, to, _]| [from, to])
}
