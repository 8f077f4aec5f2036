//! Contacts of spheres with walls: meshes compared with the shapes that they represent and with
//! exhaustive search.

mod brute;
mod files;
mod frames;
mod inside;
mod meshes;
mod solids;

use dem_physics::geometry::{Mesh, Shape, Touch};
use nalgebra::Vector3;

/// Vertices and triangles.
pub(crate) type Surface = (Vec<[f64; 3]>, Vec<[u32; 3]>);

pub(crate) fn mesh((vertices, triangles): &Surface) -> Mesh {
    Mesh::new(vertices, triangles).unwrap()
}

/// All touches, sorted by their features.
pub(crate) fn touches(shape: &Shape, centre: [f64; 3], reach: f64) -> Vec<Touch> {
    let mut found = Vec::new();
    shape.touches(centre, reach, &mut found);
    found.sort_by_key(|touch| touch.feature);
    found
}

pub(crate) fn apart(a: [f64; 3], b: [f64; 3]) -> f64 {
    (Vector3::from(a) - Vector3::from(b)).norm()
}

/// The same point, distance and normal within `error`.
#[track_caller]
pub(crate) fn assert_same(found: &Touch, wanted: &Touch, error: f64, what: &str) {
    assert!(
        apart(found.point, wanted.point) <= error
            && (found.distance_m - wanted.distance_m).abs() <= error
            && apart(found.normal, wanted.normal) <= error / wanted.distance_m.abs().min(1.0),
        "{what}: {found:?} instead of {wanted:?}"
    );
}

/// A box with each face divided into `n` by `n` squares of two triangles, with diagonals in either
/// direction. Faces share vertices.
pub(crate) fn box_surface(low: [f64; 3], high: [f64; 3], n: u32) -> Surface {
    let mut surface = (Vec::new(), Vec::new());
    for axis in 0..3_usize {
        for side in 0..2_u32 {
            let place = |i: u32, j: u32| {
                let mut at = [0; 3];
                at[axis] = side * n;
                at[(axis + 1) % 3] = i;
                at[(axis + 2) % 3] = j;
                [0, 1, 2].map(|k| {
                    // Ends are exact.
                    let fraction = f64::from(at[k]) / f64::from(n);
                    low[k] * (1.0 - fraction) + high[k] * fraction
                })
            };
            add_tiles(&mut surface, n, place);
        }
    }
    surface
}

/// Adds `n` by `n` squares with corners given by `place`.
pub(crate) fn add_tiles(surface: &mut Surface, n: u32, place: impl Fn(u32, u32) -> [f64; 3]) {
    for i in 0..n {
        for j in 0..n {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let [a, b, c, d] = corners.map(|(i, j)| vertex(surface, place(i, j)));
            let pair = if (i + j) % 2 == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            surface.1.extend(pair);
        }
    }
}

fn vertex(surface: &mut Surface, point: [f64; 3]) -> u32 {
    let known = surface.0.iter().position(|v| *v == point);
    known.unwrap_or_else(|| {
        surface.0.push(point);
        surface.0.len() - 1
    }) as u32
}
