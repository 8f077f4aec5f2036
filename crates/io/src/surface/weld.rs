//! Corners of facets -> shared vertices: first those that are equal, then, where that leaves open
//! edges, those that are near.

use super::mesh::{Edges, Mesh, Point, mean};
use super::sets::Sets;
use crate::bounds::Bounds;
use crate::boxes::Tree;

/// Corners farther apart than this share of the diagonal of the bounding box are never taken for
/// one.
pub(super) const LARGEST_TOLERANCE: f64 = 3e-5;

/// The tolerances that are tried, as shares of the diagonal.
const TOLERANCES: [f64; 8] = [1e-8, 3e-8, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, LARGEST_TOLERANCE];

/// With more near pairs than this for each vertex, the tolerance is too large for the surface.
const MOST_NEIGHBOURS: usize = 16;

/// Welds corners that are equal (0.0 and -0.0 are). Vertices are sorted by their coordinates, so
/// that the result does not depend on the order of the facets, except that triangle i is facet i.
pub(super) fn equal_corners(facets: &[[Point; 3]]) -> Mesh {
    let slots = (2 * facets.len()).next_power_of_two().max(16);
    let mut table = vec![u32::MAX; slots];
    let mut mesh = Mesh {
        vertices: Vec::with_capacity(facets.len() / 2),
        triangles: Vec::with_capacity(facets.len()),
    };
    for facet in facets {
        let triangle = facet.map(|corner| {
            let corner = corner.map(|x| x + 0.0);
            if 2 * mesh.vertices.len() >= table.len() {
                table = vec![u32::MAX; 2 * table.len()];
                for (v, vertex) in mesh.vertices.iter().enumerate() {
                    let slot = find_slot(&table, &mesh.vertices, vertex);
                    table[slot] = v as u32;
                }
            }
            let slot = find_slot(&table, &mesh.vertices, &corner);
            if table[slot] == u32::MAX {
                table[slot] = mesh.vertices.len() as u32;
                mesh.vertices.push(corner);
            }
            table[slot]
        });
        mesh.triangles.push(triangle);
    }
    mesh.order_vertices();
    mesh
}

/// The slot of the hash table (a power of two long) that holds the vertex equal to `point`, or the
/// empty one where it belongs.
fn find_slot(table: &[u32], vertices: &[Point], point: &Point) -> usize {
    let mut hash = 0_u64;
    for x in point {
        hash = (hash ^ x.to_bits())
            .wrapping_mul(0x9e37_79b9_7f4a_7c15)
            .rotate_left(29);
    }
    let mut slot = (hash.wrapping_mul(0xd6e8_feb8_6659_fd93) >> 20) as usize & (table.len() - 1);
    while table[slot] != u32::MAX && vertices[table[slot] as usize] != *point {
        slot = (slot + 1) & (table.len() - 1);
    }
    slot
}

/// What welding of near vertices came to.
pub(super) struct Welded {
    /// Vertices that are no more.
    pub(super) vertices_gone: usize,
    /// Largest distance between two vertices that were joined, local units.
    pub(super) tolerance: f64,
}

/// Welds vertices of open edges that are near each other, with growing tolerance, until no edge is
/// open; `None` when that closes no edge. Of several tolerances that leave as many open edges, the
/// smallest is taken. Some triangles may lose their area.
pub(super) fn near_vertices(mesh: &mut Mesh, edges: &Edges, diagonal: f64) -> Option<Welded> {
    let mut at_bad_edge: Vec<u32> = edges
        .groups()
        .filter(|g| g.len() % 2 == 1)
        .flat_map(|g| mesh.half_edge(g[0]))
        .collect();
    at_bad_edge.sort_unstable();
    at_bad_edge.dedup();
    let points: Vec<Bounds> = at_bad_edge
        .iter()
        .map(|v| Bounds::of([mesh.vertices[*v as usize]]))
        .collect();
    let tree = Tree::new(&points);
    let mut best: Option<Clusters> = None;
    let mut fewest_bad = edges.bad_count();
    for tolerance in TOLERANCES.map(|fraction| fraction * diagonal) {
        if fewest_bad == 0 {
            break;
        }
        let Ok(clusters) = clusters_within(mesh, &at_bad_edge, &tree, tolerance) else {
            break;
        };
        let Some(clusters) = clusters else { continue };
        let bad = clusters.bad_edges(mesh);
        if bad < fewest_bad {
            fewest_bad = bad;
            best = Some(clusters);
        }
    }
    best.map(|clusters| clusters.join(mesh))
}

/// Vertices that are to become one.
struct Clusters {
    /// Cluster and vertex, sorted; vertices that stay alone are left out.
    members: Vec<(u32, u32)>,
    /// The first vertex of its cluster for each vertex of the mesh.
    joined_to: Vec<u32>,
    /// Largest distance between two vertices that made them one cluster.
    tolerance: f64,
}

/// Very many vertices lie within a tolerance of each other.
struct TooDense;

/// Clusters of those of `vertices` that lie within `tolerance` of each other. `None` when there are
/// none, or one is much wider than that: then the distances between neighbouring vertices of the
/// surface are no larger than the tolerance.
fn clusters_within(
    mesh: &Mesh,
    vertices: &[u32],
    tree: &Tree,
    tolerance: f64,
) -> Result<Option<Clusters>, TooDense> {
    let mut sets = Sets::new(vertices.len());
    let mut largest = 0.0_f64;
    let mut pairs = 0;
    let most_pairs = MOST_NEIGHBOURS * vertices.len();
    tree.near_pairs(tolerance, |i, j| {
        let [a, b] = [i, j].map(|k| mesh.vertices[vertices[k as usize] as usize]);
        let apart = (a - b).norm();
        if apart <= tolerance {
            sets.join(i, j, false);
            largest = largest.max(apart);
            pairs += 1;
        }
        pairs <= most_pairs
    });
    if pairs > most_pairs {
        return Err(TooDense);
    }
    if largest == 0.0 {
        return Ok(None);
    }
    let mut all: Vec<(u32, u32)> = (0..vertices.len() as u32)
        .map(|i| (sets.find(i).0, vertices[i as usize]))
        .collect();
    all.sort_unstable();
    let mut clusters = Clusters {
        members: Vec::new(),
        joined_to: (0..mesh.vertices.len() as u32).collect(),
        tolerance: largest,
    };
    for cluster in all
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|cluster| cluster.len() > 1)
    {
        let points = cluster.iter().map(|(_, v)| mesh.vertices[*v as usize]);
        if Bounds::of(points).diagonal_m() > 8.0 * tolerance {
            return Ok(None);
        }
        cluster
            .iter()
            .for_each(|(_, v)| clusters.joined_to[*v as usize] = cluster[0].1);
        clusters.members.extend(cluster);
    }
    Ok(Some(clusters))
}

impl Clusters {
    /// Edges that will have an odd number of facets, not counting triangles of which two corners
    /// become one.
    fn bad_edges(&self, mesh: &Mesh) -> usize {
        let joined = mesh
            .triangles
            .iter()
            .map(|triangle| triangle.map(|v| self.joined_to[v as usize]));
        let whole: Vec<[u32; 3]> = joined
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        Edges::of_triangles(&whole, mesh.vertices.len()).bad_count()
    }

    /// Joins each cluster in its middle.
    fn join(self, mesh: &mut Mesh) -> Welded {
        let mut clusters = 0;
        for cluster in self.members.chunk_by(|a, b| a.0 == b.0) {
            mesh.vertices[cluster[0].1 as usize] =
                mean(cluster.iter().map(|(_, v)| mesh.vertices[*v as usize]));
            clusters += 1;
        }
        mesh.triangles
            .iter_mut()
            .flatten()
            .for_each(|v| *v = self.joined_to[*v as usize]);
        Welded {
            vertices_gone: self.members.len() - clusters,
            tolerance: self.tolerance,
        }
    }
}
