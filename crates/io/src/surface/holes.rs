//! Holes of a surface: the loops of its open edges, and triangles that close them.

use super::mesh::{Edges, Mesh, Point, mean, normal};
use std::collections::BTreeMap;

/// A hole with a longer boundary, as a share of the diagonal of the bounding box, is not small; but
/// one with three edges, where just one facet is missing, always is.
pub(super) const LONGEST_BOUNDARY: f64 = 0.5;

/// Up to so many edges, a hole is closed by the triangles of least area over its vertices; beyond,
/// by a fan around its middle.
const MOST_EDGES_FOR_LEAST_AREA: usize = 200;

/// The boundary of a hole: vertices in the order in which new triangles must run along them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hole {
    pub(super) boundary: Vec<u32>,
}

impl Hole {
    /// Length of the boundary, local units.
    pub(super) fn perimeter(&self, mesh: &Mesh) -> f64 {
        let next = self.boundary.iter().cycle().skip(1);
        self.boundary
            .iter()
            .zip(next)
            .map(|(a, b)| (mesh.vertices[*a as usize] - mesh.vertices[*b as usize]).norm())
            .sum()
    }

    /// The middle of the boundary's vertices.
    pub(super) fn middle(&self, mesh: &Mesh) -> Point {
        mean(self.boundary.iter().map(|v| mesh.vertices[*v as usize]))
    }

    /// Whether it may be closed, in a mesh whose bounding box has this diagonal.
    pub(super) fn is_small(&self, mesh: &Mesh, diagonal: f64) -> bool {
        self.boundary.len() == 3 || self.perimeter(mesh) <= LONGEST_BOUNDARY * diagonal
    }
}

/// The loops of open edges; `turned` tells which triangles are wound the other way than they stand
/// in the mesh.
pub(super) fn find(mesh: &Mesh, edges: &Edges, turned: &[bool]) -> Vec<Hole> {
    let mut steps: Vec<[u32; 2]> = edges
        .open()
        .map(|h| {
            let [start, end] = mesh.half_edge(h);
            if turned[h as usize / 3] {
                [start, end]
            } else {
                [end, start]
            }
        })
        .collect();
    steps.sort_unstable();
    let mut used = vec![false; steps.len()];
    let mut holes = Vec::new();
    // Unused steps from a vertex: the range of steps that begin there is searched from its start.
    let next_step = |used: &[bool], vertex: u32| {
        let begin = steps.partition_point(|s| s[0] < vertex);
        (begin..steps.len())
            .take_while(|i| steps[*i][0] == vertex)
            .find(|i| !used[*i])
    };
    for first in 0..steps.len() {
        if used[first] {
            continue;
        }
        // A walk along the boundary; whenever it meets itself, the loop is cut off.
        let mut path = vec![steps[first][0]];
        let mut place_on_path = BTreeMap::from([(steps[first][0], 0)]);
        while let Some(step) = path.last().and_then(|vertex| next_step(&used, *vertex)) {
            used[step] = true;
            let vertex = steps[step][1];
            if let Some(place) = place_on_path.get(&vertex).copied() {
                let boundary = path.split_off(place);
                boundary.iter().for_each(|v| {
                    place_on_path.remove(v);
                });
                holes.push(Hole { boundary });
            }
            place_on_path.insert(vertex, path.len());
            path.push(vertex);
        }
    }
    holes
}

/// Adds triangles that close `hole`; returns how many.
pub(super) fn fill(mesh: &mut Mesh, edges: &ExistingEdges, hole: &Hole) -> usize {
    let boundary = &hole.boundary;
    let before = mesh.triangles.len();
    let least = (boundary.len() <= MOST_EDGES_FOR_LEAST_AREA)
        .then(|| least_area(mesh, edges, boundary))
        .flatten();
    if let Some(triangles) = least {
        mesh.triangles.extend(triangles);
    } else {
        let middle = mesh.vertices.len() as u32;
        mesh.vertices.push(hole.middle(mesh));
        for (a, b) in boundary.iter().zip(boundary.iter().cycle().skip(1)) {
            mesh.triangles.push([*a, *b, middle]);
        }
    }
    mesh.triangles.len() - before
}

/// The edges that a mesh has, to be asked for.
pub(super) struct ExistingEdges(Vec<[u32; 2]>);

impl ExistingEdges {
    pub(super) fn of(mesh: &Mesh, edges: &Edges) -> Self {
        let mut all: Vec<[u32; 2]> = edges
            .groups()
            .map(|group| sorted(mesh.half_edge(group[0])))
            .collect();
        all.sort_unstable();
        Self(all)
    }

    fn contain(&self, a: u32, b: u32) -> bool {
        self.0.binary_search(&sorted([a, b])).is_ok()
    }
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// The triangulation of a loop with the least area that makes no edge which exists already
/// (Barequet and Sharir 1995); `None` where there is none.
fn least_area(mesh: &Mesh, edges: &ExistingEdges, boundary: &[u32]) -> Option<Vec<[u32; 3]>> {
    let n = boundary.len();
    let point = |i: usize| mesh.vertices[boundary[i] as usize];
    // area[i][j]: least area over the vertices i..=j; apex[i][j]: the third corner of the triangle
    // on the chord i-j.
    let mut area = vec![vec![0.0_f64; n]; n];
    let mut apex = vec![vec![0_usize; n]; n];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            area[i][j] = f64::INFINITY;
            let chord_exists = span < n - 1 && edges.contain(boundary[i], boundary[j]);
            if chord_exists {
                continue;
            }
            for k in i + 1..j {
                let sum =
                    area[i][k] + area[k][j] + 0.5 * normal([point(i), point(k), point(j)]).norm();
                if sum < area[i][j] {
                    area[i][j] = sum;
                    apex[i][j] = k;
                }
            }
        }
    }
    if n < 3 || !area[0][n - 1].is_finite() {
        return None;
    }
    let mut triangles = Vec::with_capacity(n - 2);
    let mut chords = vec![(0, n - 1)];
    while let Some((i, j)) = chords.pop() {
        if j - i >= 2 {
            let k = apex[i][j];
            triangles.push([boundary[i], boundary[k], boundary[j]]);
            chords.extend([(i, k), (k, j)]);
        }
    }
    Some(triangles)
}
