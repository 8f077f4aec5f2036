//! Triangles that cross each other.

use super::mesh::{Mesh, Point, normal};
use crate::boxes::Tree;
use std::collections::BTreeSet;

/// The crossings of a mesh with itself.
#[derive(Debug, Default)]
pub(super) struct Intersections {
    /// Pairs of triangles that cross and share no vertex.
    pub(super) pairs: usize,
    /// A place where two cross, local units.
    pub(super) place: Option<Point>,
    /// Shells that cross each other, or themselves; the smaller first, sorted, each pair once.
    pub(super) shells: Vec<[u32; 2]>,
}

/// Finds the pairs of triangles of which an edge of one goes through the other. Triangles that only
/// touch, or lie in one plane, do not cross. `tree` holds the boxes of the triangles.
pub(super) fn find(mesh: &Mesh, tree: &Tree, shell_of: &[u32]) -> Intersections {
    let mut pairs = 0;
    let mut first: Option<([u32; 2], Point)> = None;
    let mut shells: BTreeSet<[u32; 2]> = BTreeSet::new();
    tree.near_pairs(0.0, |a, b| {
        let pair = [a.min(b), a.max(b)];
        let corners = pair.map(|t| mesh.triangles[t as usize]);
        let share_vertex = corners[0].iter().any(|v| corners[1].contains(v));
        let crossing = if share_vertex {
            None
        } else {
            crossing_place(mesh.corners(pair[0]), mesh.corners(pair[1]))
        };
        if let Some(place) = crossing {
            pairs += 1;
            if first.is_none_or(|(before, _)| pair < before) {
                first = Some((pair, place));
            }
            let [s, t] = pair.map(|t| shell_of[t as usize]);
            shells.insert([s.min(t), s.max(t)]);
        }
        true
    });
    Intersections {
        pairs,
        place: first.map(|(_, place)| place),
        shells: shells.into_iter().collect(),
    }
}

/// A point where an edge of one triangle goes through the other.
fn crossing_place(first: [Point; 3], second: [Point; 3]) -> Option<Point> {
    let sides_of_second = sides(first, second)?;
    let sides_of_first = sides(second, first)?;
    edge_through(second, sides_of_second, first)
        .or_else(|| edge_through(first, sides_of_first, second))
}

/// Signed distances of the corners of `other` from the plane of `triangle`, times twice its area;
/// those within rounding are zero. `None` when the corners do not lie on both sides.
fn sides(triangle: [Point; 3], other: [Point; 3]) -> Option<[f64; 3]> {
    let normal = normal(triangle);
    let area = normal.norm();
    let longest = (triangle[1] - triangle[0]).norm() * (triangle[2] - triangle[0]).norm();
    let sides = other.map(|corner| {
        let to_corner = corner - triangle[0];
        let side = normal.dot(&to_corner);
        if side.abs() <= 1e-11 * area + 1e-14 * longest * to_corner.norm() {
            0.0
        } else {
            side
        }
    });
    (sides.iter().any(|s| *s > 0.0) && sides.iter().any(|s| *s < 0.0)).then_some(sides)
}

/// Where an edge of `triangle`, whose corners lie at `sides` of the plane of `other`, goes through
/// `other`.
fn edge_through(triangle: [Point; 3], sides: [f64; 3], other: [Point; 3]) -> Option<Point> {
    (0..3).find_map(|k| {
        let (from, to) = (sides[k], sides[(k + 1) % 3]);
        if from * to >= 0.0 {
            return None;
        }
        let edge = triangle[(k + 1) % 3] - triangle[k];
        let place = triangle[k] + from / (from - to) * edge;
        contains(other, place).then_some(place)
    })
}

/// Whether a point of the plane of a triangle lies in it or on its edge.
fn contains(triangle: [Point; 3], point: Point) -> bool {
    let normal = normal(triangle);
    let whole = normal.dot(&normal);
    (0..3).all(|k| {
        let edge = triangle[(k + 1) % 3] - triangle[k];
        normal.dot(&edge.cross(&(point - triangle[k]))) >= -1e-12 * whole
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]
    use super::*;

    const FLAT: [Point; 3] = [
        Point::new(0.0, 0.0, 0.0),
        Point::new(1.0, 0.0, 0.0),
        Point::new(0.0, 1.0, 0.0),
    ];

    #[test]
    fn crossing_touching_and_coplanar_triangles() {
        let through = [[0.2, 0.2, -0.5], [0.3, 0.2, 0.5], [0.3, 0.4, 0.5]].map(Point::from);
        let place = crossing_place(FLAT, through).unwrap();
        assert!(place[2].abs() < 1e-15 && crossing_place(through, FLAT).is_some());
        let beside = through.map(|p| p + Point::new(0.6, 0.0, 0.0));
        let touching = [[0.2, 0.2, 0.0], [0.3, 0.2, 0.5], [0.3, 0.4, 0.5]].map(Point::from);
        let coplanar = FLAT.map(|p| p + Point::new(0.1, 0.1, 0.0));
        for other in [beside, touching, coplanar] {
            assert_eq!(crossing_place(FLAT, other), None);
        }
    }
}
