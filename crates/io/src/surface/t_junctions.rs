//! T-junctions: edges that are split by a vertex on one side only. They are closed in space but not
//! by shared edges.

use super::mesh::{Edges, Mesh};
use crate::bounds::Bounds;
use crate::boxes::Tree;

/// A triangle has three edges, and new triangles may have to be split again.
const ROUNDS: usize = 12;

/// Splits open edges at the vertices of other open edges that lie on them, within `tolerance`
/// (local units), and their triangles with them, so that both sides of a T-junction have the same
/// edges. Returns how many edges were split. Ends when that closes nothing more.
pub(super) fn split(mesh: &mut Mesh, tolerance: f64) -> usize {
    let mut split_edges = 0;
    let mut open_before = usize::MAX;
    for _ in 0..ROUNDS {
        let open: Vec<u32> = Edges::of(mesh).open().collect();
        if open.len() >= open_before {
            break;
        }
        open_before = open.len();
        let on_edges = vertices_on_edges(mesh, &open, tolerance);
        let mut touched = vec![false; mesh.triangles.len()];
        for on_edge in on_edges.chunk_by(|a, b| a.half_edge == b.half_edge) {
            let half_edge = on_edge[0].half_edge;
            if !std::mem::replace(&mut touched[half_edge as usize / 3], true) {
                split_triangle(mesh, half_edge, on_edge);
                split_edges += 1;
            }
        }
        if on_edges.is_empty() {
            break;
        }
    }
    split_edges
}

/// A vertex that lies on a half-edge, at `share` of the way.
struct OnEdge {
    half_edge: u32,
    fraction: f64,
    vertex: u32,
}

/// All vertices of open edges that lie on other open edges, sorted along each of them.
fn vertices_on_edges(mesh: &Mesh, open: &[u32], tolerance: f64) -> Vec<OnEdge> {
    let mut vertices: Vec<u32> = open.iter().flat_map(|h| mesh.half_edge(*h)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let points: Vec<Bounds> = vertices
        .iter()
        .map(|v| Bounds::of([mesh.vertices[*v as usize]]))
        .collect();
    let tree = Tree::new(&points);
    let mut found = Vec::new();
    for half_edge in continued_edges(mesh, open, tolerance) {
        let [start, end] = mesh.segment(half_edge);
        let edge = end - start;
        // What is shorter than the tolerance is not split any further.
        if edge.norm() <= 2.0 * tolerance {
            continue;
        }
        tree.visit(
            |b| b.on_segment([start, end], tolerance),
            |i| {
                let vertex = vertices[i as usize];
                if mesh.triangles[half_edge as usize / 3].contains(&vertex) {
                    return;
                }
                let point = mesh.vertices[vertex as usize];
                let fraction = (point - start).dot(&edge) / edge.dot(&edge);
                let apart = (point - (start + fraction * edge)).norm();
                if fraction > 0.0 && fraction < 1.0 && apart <= tolerance {
                    found.push(OnEdge {
                        half_edge,
                        fraction,
                        vertex,
                    });
                }
            },
        );
    }
    found.sort_unstable_by(|a, b| {
        a.half_edge
            .cmp(&b.half_edge)
            .then(a.fraction.total_cmp(&b.fraction))
            .then(a.vertex.cmp(&b.vertex))
    });
    found
}

/// The open edges that meet, at both ends, another open edge on the same line: the edges of every
/// T-junction do.
fn continued_edges(mesh: &Mesh, open: &[u32], tolerance: f64) -> Vec<u32> {
    let mut ends: Vec<(u32, u32)> = Vec::with_capacity(2 * open.len());
    for half_edge in open {
        let [start, end] = mesh.half_edge(*half_edge);
        ends.extend([(start, end), (end, start)]);
    }
    ends.sort_unstable();
    let continued = |from: u32, to: u32| {
        let begin = ends.partition_point(|e| e.0 < from);
        let mut others = ends[begin..]
            .iter()
            .take_while(|e| e.0 == from)
            .filter(|e| e.1 != to);
        others.any(|e| on_one_line(mesh, from, to, e.1, tolerance))
    };
    let both_ends = |h: &u32| {
        let [start, end] = mesh.half_edge(*h);
        continued(start, end) && continued(end, start)
    };
    open.iter().copied().filter(both_ends).collect()
}

/// Whether the nearer of two vertices lies on the line from a third one to the farther.
fn on_one_line(mesh: &Mesh, from: u32, a: u32, b: u32, tolerance: f64) -> bool {
    let [from, a, b] = [from, a, b].map(|v| mesh.vertices[v as usize]);
    let (near, far) = if (from - a).norm() < (from - b).norm() {
        (a, b)
    } else {
        (b, a)
    };
    let (to_near, to_far) = (near - from, far - from);
    let fraction = to_near.dot(&to_far) / to_far.dot(&to_far);
    (near - (from + fraction * to_far)).norm() <= tolerance
}

/// Replaces the triangle of `half_edge` by a fan from its opposite corner to the pieces of the
/// half-edge.
fn split_triangle(mesh: &mut Mesh, half_edge: u32, on_edge: &[OnEdge]) {
    let triangle = half_edge as usize / 3;
    let opposite = mesh.triangles[triangle][(half_edge as usize + 2) % 3];
    let [start, end] = mesh.half_edge(half_edge);
    let mut from = start;
    for on_edge in on_edge {
        mesh.triangles.push([from, on_edge.vertex, opposite]);
        from = on_edge.vertex;
    }
    mesh.triangles[triangle] = [from, end, opposite];
}
