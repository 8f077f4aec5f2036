//! Rays through a mesh: which shells they cross, and in which sense (Moeller and Trumbore 1997).

use super::mesh::{Mesh, Point};
use crate::bounds::Bounds;
use crate::boxes::Tree;

/// Directions in no special position to the axes or to each other. Not of length 1, none along an
/// axis.
const DIRECTIONS: [Point; 8] = [
    Point::new(0.531, 0.321, 0.785),
    Point::new(-0.414, 0.732, 0.541),
    Point::new(0.237, -0.645, 0.726),
    Point::new(-0.693, -0.302, 0.655),
    Point::new(0.139, 0.916, -0.377),
    Point::new(-0.851, 0.211, -0.482),
    Point::new(0.359, -0.474, -0.804),
    Point::new(-0.127, -0.552, -0.824),
];

/// A point nearer to a facet than this (local units) lies on it.
const ON_FACET: f64 = 1e-9;

/// A mesh of shells with a search tree.
pub(super) struct Rays<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) tree: &'a Tree,
    /// Shell of each triangle.
    pub(super) shell_of: &'a [u32],
}

/// Where a ray crosses a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hit {
    /// How far along the ray, in lengths of its direction.
    pub(super) at: f64,
    pub(super) shell: u32,
    /// +1 where the ray leaves the side that the normal points away from, -1 where it enters it.
    pub(super) sense: i32,
}

/// The shells around a point.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Around {
    /// Shells that wind around the point.
    pub(super) inside: Vec<u32>,
    /// Shells that the point lies on.
    pub(super) on: Vec<u32>,
}

impl Rays<'_> {
    /// The crossings of a ray, in no order. False where it grazes a facet, so that they cannot be
    /// relied on.
    pub(super) fn crossings(&self, origin: Point, direction: Point, hits: &mut Vec<Hit>) -> bool {
        hits.clear();
        let mut sure = true;
        let inverse = direction.map(|x| 1.0 / x);
        self.tree.visit(
            |b: &Bounds| b.on_ray(&origin, &inverse),
            |triangle| match cross_triangle(origin, direction, self.mesh.corners(triangle)) {
                Crossing::Miss => {}
                Crossing::Hit(at, sense) => hits.push(Hit {
                    at,
                    shell: self.shell_of[triangle as usize],
                    sense,
                }),
                Crossing::Grazed => sure = false,
            },
        );
        sure
    }

    /// The shells that wind around a point or have it on them. `None` when every direction grazes a
    /// facet.
    pub(super) fn around(&self, point: Point) -> Option<Around> {
        let mut hits = Vec::new();
        let direction = DIRECTIONS
            .iter()
            .find(|d| self.crossings(point, **d, &mut hits))?;
        hits.sort_unstable_by_key(|hit| hit.shell);
        let mut around = Around::default();
        for of_shell in hits.chunk_by(|a, b| a.shell == b.shell) {
            if of_shell
                .iter()
                .any(|hit| hit.at.abs() * direction.norm() < ON_FACET)
            {
                around.on.push(of_shell[0].shell);
            } else if of_shell
                .iter()
                .filter(|hit| hit.at > 0.0)
                .map(|hit| hit.sense)
                .sum::<i32>()
                != 0
            {
                around.inside.push(of_shell[0].shell);
            }
        }
        Some(around)
    }
}

enum Crossing {
    Miss,
    Hit(f64, i32),
    Grazed,
}

/// Crossing of the line from a little before `origin` on with a triangle.
fn cross_triangle(origin: Point, direction: Point, [a, b, c]: [Point; 3]) -> Crossing {
    const EDGE: f64 = 1e-10;
    let (edge_1, edge_2) = (b - a, c - a);
    let p = direction.cross(&edge_2);
    let determinant = edge_1.dot(&p);
    let from_a = origin - a;
    if determinant.abs() <= 1e-12 * edge_1.norm() * edge_2.norm() {
        let normal = edge_1.cross(&edge_2);
        return if from_a.dot(&normal).abs() > 1e-8 * normal.norm() {
            Crossing::Miss
        } else {
            Crossing::Grazed
        };
    }
    let u = from_a.dot(&p) / determinant;
    let q = from_a.cross(&edge_1);
    let v = direction.dot(&q) / determinant;
    if u < -EDGE || v < -EDGE || u + v > 1.0 + EDGE {
        return Crossing::Miss;
    }
    let at = edge_2.dot(&q) / determinant;
    if at < -2.0 * ON_FACET {
        Crossing::Miss
    } else if u < EDGE || v < EDGE || u + v > 1.0 - EDGE {
        Crossing::Grazed
    } else {
        Crossing::Hit(at, if determinant < 0.0 { 1 } else { -1 })
    }
}
