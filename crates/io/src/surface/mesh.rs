//! Triangles that share vertices, and their edges.

use nalgebra::Vector3;

/// A point or a vector.
pub(super) type Point = Vector3<f64>;

/// Vertices in local units and triangles of them.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Mesh {
    pub(super) vertices: Vec<Point>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Mesh {
    pub(super) fn corners(&self, triangle: u32) -> [Point; 3] {
        self.triangles[triangle as usize].map(|v| self.vertices[v as usize])
    }

    /// Start and end of a half-edge: half-edge 3t + k runs from corner k of triangle t to the next
    /// corner.
    pub(super) fn half_edge(&self, half_edge: u32) -> [u32; 2] {
        let triangle = self.triangles[half_edge as usize / 3];
        let k = half_edge as usize % 3;
        [triangle[k], triangle[(k + 1) % 3]]
    }

    /// The two points of a half-edge.
    pub(super) fn segment(&self, half_edge: u32) -> [Point; 2] {
        self.half_edge(half_edge).map(|v| self.vertices[v as usize])
    }

    /// Volume enclosed by some triangles, negative when they are wound inwards. Summed relative to
    /// a vertex of theirs.
    pub(super) fn signed_volume(&self, triangles: impl IntoIterator<Item = u32>) -> f64 {
        let mut reference = None;
        let mut sum = 0.0;
        for triangle in triangles {
            let corners = self.corners(triangle);
            let origin = *reference.get_or_insert(corners[0]);
            let [a, b, c] = corners.map(|p| p - origin);
            sum += a.dot(&b.cross(&c));
        }
        sum / 6.0
    }

    pub(super) fn area(&self, triangles: impl IntoIterator<Item = u32>) -> f64 {
        triangles
            .into_iter()
            .map(|t| 0.5 * normal(self.corners(t)).norm())
            .sum()
    }

    /// Puts vertices and triangles in an order that does not depend on the order before: vertices
    /// by their coordinates, each triangle beginning with its smallest vertex. Vertices without a
    /// triangle are left out. The triangles keep their order.
    pub(super) fn order_vertices(&mut self) {
        let mut used = vec![false; self.vertices.len()];
        self.triangles
            .iter()
            .flatten()
            .for_each(|v| used[*v as usize] = true);
        let mut order: Vec<u32> = (0..self.vertices.len() as u32)
            .filter(|v| used[*v as usize])
            .collect();
        let vertices = &self.vertices;
        order.sort_unstable_by(|a, b| {
            compare(&vertices[*a as usize], &vertices[*b as usize]).then(a.cmp(b))
        });
        let mut place = vec![0_u32; self.vertices.len()];
        for (new, old) in order.iter().enumerate() {
            place[*old as usize] = new as u32;
        }
        self.vertices = order
            .iter()
            .map(|old| self.vertices[*old as usize])
            .collect();
        for triangle in &mut self.triangles {
            *triangle = smallest_first(triangle.map(|v| place[v as usize]));
        }
    }
}

/// Normal of a triangle, as long as twice its area.
pub(super) fn normal([a, b, c]: [Point; 3]) -> Point {
    (b - a).cross(&(c - a))
}

/// The middle of some points. Not for none.
pub(super) fn mean(points: impl IntoIterator<Item = Point, IntoIter: ExactSizeIterator>) -> Point {
    let points = points.into_iter();
    let count = points.len() as f64;
    points.sum::<Point>() / count
}

/// Order of points by x, then y, then z.
fn compare(a: &Point, b: &Point) -> std::cmp::Ordering {
    a[0].total_cmp(&b[0])
        .then(a[1].total_cmp(&b[1]))
        .then(a[2].total_cmp(&b[2]))
}

/// The same triangle, beginning with its smallest vertex.
pub(super) fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// The half-edges of a mesh, grouped by the edge that they run along, in either direction.
pub(super) struct Edges {
    half_edges: Vec<u32>,
    /// Group i is `half_edges[starts[i]..starts[i + 1]]`.
    starts: Vec<u32>,
}

impl Edges {
    /// Groups the half-edges of a mesh.
    pub(super) fn of(mesh: &Mesh) -> Self {
        Self::of_triangles(&mesh.triangles, mesh.vertices.len())
    }

    /// Groups the half-edges of triangles over so many vertices: bucket by smaller vertex, sort
    /// each bucket by larger vertex.
    pub(super) fn of_triangles(triangles: &[[u32; 3]], vertex_count: usize) -> Self {
        let mut bucket_starts = vec![0_u32; vertex_count + 1];
        let half_edge_count = 3 * triangles.len() as u32;
        let ends = |h: u32| {
            let triangle = triangles[h as usize / 3];
            let (a, b) = (triangle[h as usize % 3], triangle[(h as usize + 1) % 3]);
            (a.min(b), a.max(b))
        };
        (0..half_edge_count).for_each(|h| bucket_starts[ends(h).0 as usize + 1] += 1);
        for v in 1..bucket_starts.len() {
            bucket_starts[v] += bucket_starts[v - 1];
        }
        let mut next = bucket_starts.clone();
        let mut entries = vec![(0_u32, 0_u32); half_edge_count as usize];
        for h in 0..half_edge_count {
            let (smaller, larger) = ends(h);
            entries[next[smaller as usize] as usize] = (larger, h);
            next[smaller as usize] += 1;
        }
        let mut starts = Vec::with_capacity(half_edge_count as usize / 2 + 1);
        for v in 0..vertex_count {
            let begin = bucket_starts[v] as usize;
            let bucket = &mut entries[begin..bucket_starts[v + 1] as usize];
            bucket.sort_unstable();
            for (k, entry) in bucket.iter().enumerate() {
                if k == 0 || bucket[k - 1].0 != entry.0 {
                    starts.push((begin + k) as u32);
                }
            }
        }
        starts.push(half_edge_count);
        Self {
            half_edges: entries.into_iter().map(|(_, h)| h).collect(),
            starts,
        }
    }

    /// The half-edges of each edge, edges in the order of their vertices.
    pub(super) fn groups(&self) -> impl Iterator<Item = &[u32]> {
        self.starts
            .windows(2)
            .map(|w| &self.half_edges[w[0] as usize..w[1] as usize])
    }

    /// The half-edges of edges that have one facet only.
    pub(super) fn open(&self) -> impl Iterator<Item = u32> {
        self.groups()
            .filter(|group| group.len() == 1)
            .map(|group| group[0])
    }

    /// How many edges do not have an even number of facets.
    pub(super) fn bad_count(&self) -> usize {
        self.groups().filter(|group| group.len() % 2 == 1).count()
    }
}
