//! The convex hull of spheres as triangles. The only module of this crate that
//! uses parry3d.

use dem_io::{Diagnostic, Result};
use nalgebra::Vector3;
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::try_convex_hull;

/// The hull contains the hull of the same spheres with radii smaller by this fraction: each sphere
/// is represented by 162 points on it, the vertices of an icosahedron divided twice.
pub const SMALLER_BY: f64 = 0.02;

/// Number of times that the faces of the icosahedron are divided into four.
const DIVISIONS: usize = 2;

/// Corners of a triangle, counterclockwise as seen from outside. Shape 3 x 3.
pub type Facet = [[f64; 3]; 3];

/// Triangles of the convex hull of some spheres, m: centres, m, shape n x 3, and radii, m, length
/// n.
///
/// It lies within the hull of the spheres: see [`SMALLER_BY`]. There must be a sphere, and the
/// centres must be so near each other that a hull is found.
pub fn convex_hull(centres_m: &[[f64; 3]], radii_m: &[f64]) -> Result<Vec<Facet>> {
    let directions = directions();
    let Some(origin) = centres_m.first().copied().map(Vector3::from) else {
        return Err(refusal("there are no spheres"));
    };
    // Near the origin, so that no digits are lost.
    let spheres: Vec<(Vector3<f64>, f64)> = (centres_m.iter().zip(radii_m))
        .map(|(centre, radius)| (Vector3::from(*centre) - origin, *radius))
        .collect();
    let first = hull_of(extreme_points(&spheres, &directions))?;
    // A sphere inside the hull of others is not on the hull of all.
    let planes = planes(&first);
    let is_inside = |(centre, radius): &(Vector3<f64>, f64)| {
        let below = |(normal, offset): &(Vector3<f64>, f64)| centre.dot(normal) + radius < *offset;
        planes.iter().all(below)
    };
    let outer = spheres.iter().filter(|sphere| !is_inside(sphere));
    let points = outer.flat_map(|(centre, radius)| {
        let radius = *radius;
        directions.iter().map(move |d| centre + radius * d)
    });
    let points: Vec<Vector3<f64>> = points.chain(first.into_iter().flatten()).collect();
    let facets = hull_of(points)?;
    let moved = facets.iter();
    Ok(moved
        .map(|facet| facet.map(|corner| (corner + origin).into()))
        .collect())
}

fn refusal(problem: impl Into<String>) -> Diagnostic {
    Diagnostic::failed("convex hull", problem, "leave this fragment out")
}

/// For each direction the outermost point of all spheres.
fn extreme_points(
    spheres: &[(Vector3<f64>, f64)],
    directions: &[Vector3<f64>],
) -> Vec<Vector3<f64>> {
    let outermost = |direction: &Vector3<f64>| {
        let reach = |(centre, radius): &(Vector3<f64>, f64)| centre.dot(direction) + radius;
        let best = spheres.iter().max_by(|a, b| reach(a).total_cmp(&reach(b)));
        best.map(|(centre, radius)| centre + *radius * direction)
    };
    directions.iter().filter_map(outermost).collect()
}

fn hull_of(points: Vec<Vector3<f64>>) -> Result<Vec<[Vector3<f64>; 3]>> {
    let points: Vec<Vector> = points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let (vertices, triangles) =
        try_convex_hull(&points).map_err(|error| refusal(format!("none is found: {error}")))?;
    let corner = |v: u32| {
        let vertex = vertices[v as usize];
        Vector3::new(vertex.x, vertex.y, vertex.z)
    };
    Ok(triangles.iter().map(|t| t.map(corner)).collect())
}

/// Outward unit normal and distance from the origin of each facet with an area.
fn planes(facets: &[[Vector3<f64>; 3]]) -> Vec<(Vector3<f64>, f64)> {
    let plane = |[a, b, c]: &[Vector3<f64>; 3]| {
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
        Some((normal, normal.dot(a)))
    };
    facets.iter().filter_map(plane).collect()
}

/// Unit vectors in all directions: the vertices of an icosahedron divided [`DIVISIONS`] times, each
/// once.
fn directions() -> Vec<Vector3<f64>> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut corners: Vec<Vector3<f64>> = Vec::new();
    for (one, other) in [
        (1.0, golden),
        (-1.0, golden),
        (1.0, -golden),
        (-1.0, -golden),
    ] {
        corners.extend([
            Vector3::new(0.0, one, other),
            Vector3::new(one, other, 0.0),
            Vector3::new(other, 0.0, one),
        ]);
    }
    for corner in &mut corners {
        corner.normalize_mut();
    }
    // Corners of the icosahedron are neighbours if nothing lies between them: each has five.
    let mut edge = 2.0 * (1.0 / (1.0 + golden * golden)).sqrt();
    for _ in 0..DIVISIONS {
        let count = corners.len();
        let mut middles = Vec::new();
        for a in 0..count {
            for b in 0..a {
                if (corners[a] - corners[b]).norm() < 1.3 * edge {
                    middles.push((corners[a] + corners[b]).normalize());
                }
            }
        }
        corners.extend(middles);
        edge *= 0.5;
    }
    corners
}
