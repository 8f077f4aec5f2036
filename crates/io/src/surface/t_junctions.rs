//! T-junctions: edges that are split by a vertex on one side only. They are closed in space but not by shared edges.

use super::boxes::{Bounds, Tree};
use super::mesh::{Edges, Mesh};
use super::vector::{along, distance, dot, subtract};

/// A triangle has three edges, and new triangles may have to be split again.
const ROUNDS: usize = 12;

/// Splits open edges at the vertices of other open edges that lie on them, within `tolerance` (local units), and their triangles
/// with them, so that both sides of a T-junction have the same edges. Returns how many edges were split.
pub(super) fn split(mesh: &mut Mesh, tolerance: f64) -> usize {
    let mut split_edges = 0;
    for _ in 0..ROUNDS {
        let on_edges = vertices_on_open_edges(mesh, tolerance);
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
    share: f64,
    vertex: u32,
}

/// All vertices of open edges that lie on other open edges, sorted along each of them.
fn vertices_on_open_edges(mesh: &Mesh, tolerance: f64) -> Vec<OnEdge> {
    let mut open: Vec<u32> = Edges::of(mesh).open().collect();
    let mut vertices: Vec<u32> = open.iter().flat_map(|h| mesh.half_edge(*h)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    // What is shorter than the tolerance is not split any further.
    open.retain(|h| {
        let [start, end] = mesh.segment(*h);
        distance(start, end) > 2.0 * tolerance
    });
    let tree = Tree::new(
        &open
            .iter()
            .map(|h| Bounds::of(mesh.segment(*h)).grown(tolerance))
            .collect::<Vec<_>>(),
    );
    let mut found = Vec::new();
    for vertex in vertices {
        let point = mesh.vertices[vertex as usize];
        let place = Bounds::of([point]);
        tree.visit(
            |b| b.overlaps(&place),
            |i| {
                let half_edge = open[i as usize];
                if mesh.triangles[half_edge as usize / 3].contains(&vertex) {
                    return;
                }
                let [start, end] = mesh.segment(half_edge);
                let edge = subtract(end, start);
                let share = dot(subtract(point, start), edge) / dot(edge, edge);
                if share > 0.0
                    && share < 1.0
                    && distance(point, along(start, share, edge)) <= tolerance
                {
                    found.push(OnEdge {
                        half_edge,
                        share,
                        vertex,
                    });
                }
            },
        );
    }
    found.sort_unstable_by(|a, b| {
        a.half_edge
            .cmp(&b.half_edge)
            .then(a.share.total_cmp(&b.share))
            .then(a.vertex.cmp(&b.vertex))
    });
    found
}

/// Replaces the triangle of `half_edge` by a fan from its opposite corner to the pieces of the half-edge.
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
