//! The features of a mesh: flat parts, straight edges, corners. A face or edge of the model is one
//! feature, however it is tiled.

use nalgebra::Vector3;

use dem_io::Bounds;
use dem_io::disjoint::{find, join};

use super::triangle::Triangle;

/// Corners of a flat part may be off its plane by this fraction of the diagonal: a few times the
/// rounding error of single precision.
const ROUGHNESS: f64 = 3e-7;

/// Sine of the largest angle between two directions that count as one, besides the effect of
/// roughness on short lengths.
const STRAIGHT: f64 = 1e-5;

/// Features of each triangle.
#[derive(Debug, Default)]
pub(super) struct Features {
    /// The feature of each region of each triangle. Flat parts come first, then edges, then
    /// corners.
    pub(super) of_regions: Vec<[u32; 7]>,
    /// The largest extent of the flat parts at each feature, m.
    pub(super) extents_m: Vec<f32>,
    pub(super) flat_parts: u32,
    pub(super) straight_edges: u32,
    pub(super) corners: u32,
    /// Edges that belong to one triangle only.
    pub(super) open_edges: usize,
    /// Edges that belong to more than two triangles.
    pub(super) crowded_edges: usize,
    /// Edges with different numbers of triangles in the two directions.
    pub(super) unpaired_edges: usize,
}

/// The edges and the triangles that share each.
struct Edges {
    sharing: Vec<u32>,
    /// Edge i is shared by `sharing[starts[i]..starts[i + 1]]`.
    starts: Vec<u32>,
    /// The edges of each triangle: from its first, second, third corner.
    of: Vec<[u32; 3]>,
    /// Edges with different numbers of triangles in the two directions.
    unpaired: usize,
}

impl Edges {
    fn new(indices: &[[u32; 3]]) -> Self {
        let mut sides: Vec<([u32; 2], u32, u8)> = indices
            .iter()
            .enumerate()
            .flat_map(|(t, triangle)| {
                [0, 1, 2].map(|k| {
                    let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                    ([a.min(b), a.max(b)], t as u32, k as u8)
                })
            })
            .collect();
        sides.sort_unstable();
        let mut edges = Self {
            sharing: sides.iter().map(|(_, t, _)| *t).collect(),
            starts: vec![0],
            of: vec![[0; 3]; indices.len()],
            unpaired: 0,
        };
        let mut end = 0;
        for sharing in sides.chunk_by(|a, b| a.0 == b.0) {
            let mut rising = 0;
            for &([low, _], t, k) in sharing {
                edges.of[t as usize][k as usize] = edges.len() as u32;
                rising += usize::from(indices[t as usize][k as usize] == low);
            }
            edges.unpaired += usize::from(2 * rising != sharing.len());
            end += sharing.len() as u32;
            edges.starts.push(end);
        }
        edges
    }

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn triangles(&self, edge: u32) -> &[u32] {
        let start = self.starts[edge as usize];
        &self.sharing[start as usize..self.starts[edge as usize + 1] as usize]
    }

    /// The flat parts that meet at an edge, sorted.
    fn parts(&self, edge: u32, part_of: &[u32]) -> Vec<u32> {
        let parts = self.triangles(edge).iter().map(|t| part_of[*t as usize]);
        let mut parts: Vec<u32> = parts.collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }

    /// Whether an edge lies within a flat part.
    fn is_inner(&self, edge: u32, part_of: &[u32]) -> bool {
        let triangles = self.triangles(edge);
        let part = |t: u32| part_of[t as usize];
        triangles.len() > 1 && triangles.iter().all(|t| part(*t) == part(triangles[0]))
    }

    /// Number of edges whose number of triangles satisfies `wanted`.
    fn count(&self, wanted: impl Fn(u32) -> bool) -> usize {
        let counts = self.starts.windows(2).map(|w| w[1] - w[0]);
        counts.filter(|count| wanted(*count)).count()
    }
}

/// Finds the features of triangles with an area. `indices` are the vertices of their corners.
pub(super) fn features(triangles: &[Triangle], indices: &[[u32; 3]], diagonal: f64) -> Features {
    let edges = Edges::new(indices);
    let (part_of, flat_parts) = flat_parts(triangles, &edges, diagonal);
    // Corners of triangles, sorted by vertex: vertex, triangle, corner of the triangle.
    let mut corners: Vec<(u32, u32, u8)> = indices
        .iter()
        .enumerate()
        .flat_map(|(t, triangle)| [0, 1, 2].map(|k| (triangle[k], t as u32, k as u8)))
        .collect();
    corners.sort_unstable();
    let fans = || corners.chunk_by(|a, b| a.0 == b.0);
    let vertices: Vec<Vertex> = fans()
        .map(|fan| vertex(fan, triangles, &edges, &part_of, diagonal))
        .collect();

    let mut names: Vec<u32> = (0..edges.len() as u32).collect();
    for vertex in &vertices {
        if let Vertex::Along(a, b) = vertex {
            join(&mut names, *a, *b);
        }
    }
    let mut straight_edges = 0;
    let mut of_edges: Vec<u32> = Vec::with_capacity(edges.len());
    for edge in 0..edges.len() as u32 {
        let name = find(&mut names, edge);
        of_edges.push(if edges.is_inner(edge, &part_of) {
            part_of[edges.triangles(edge)[0] as usize]
        } else if name == edge {
            straight_edges += 1;
            flat_parts + straight_edges - 1
        } else {
            of_edges[name as usize]
        });
    }
    let mut of_regions: Vec<[u32; 7]> = (0..triangles.len())
        .map(|t| {
            let [a, b, c] = edges.of[t].map(|edge| of_edges[edge as usize]);
            [part_of[t], a, b, c, 0, 0, 0]
        })
        .collect();
    let mut single_corners = 0;
    for (fan, vertex) in fans().zip(vertices) {
        let feature = match vertex {
            Vertex::Within(part) => part,
            Vertex::Along(edge, _) => of_edges[edge as usize],
            Vertex::Corner => {
                single_corners += 1;
                flat_parts + straight_edges + single_corners - 1
            }
        };
        for &(_, t, k) in fan {
            of_regions[t as usize][4 + k as usize] = feature;
        }
    }
    Features {
        extents_m: extents_m(
            triangles,
            &of_regions,
            flat_parts + straight_edges + single_corners,
        ),
        of_regions,
        flat_parts,
        straight_edges,
        corners: single_corners,
        open_edges: edges.count(|triangles| triangles == 1),
        crowded_edges: edges.count(|triangles| triangles > 2),
        unpaired_edges: edges.unpaired,
    }
}

/// The largest extent of the flat parts at each feature, m: the diagonal of the box around a part.
fn extents_m(triangles: &[Triangle], of_regions: &[[u32; 7]], features: u32) -> Vec<f32> {
    let mut boxes = vec![Bounds::EMPTY; features as usize];
    for (triangle, [part, ..]) in triangles.iter().zip(of_regions) {
        let own = Bounds::of(triangle.corners.map(<[f64; 3]>::from));
        let whole = &mut boxes[*part as usize];
        *whole = whole.with(&own);
    }
    let mut extents_m = vec![0.0_f32; features as usize];
    for regions in of_regions {
        let of_part_m = boxes[regions[0] as usize].diagonal_m() as f32;
        for feature in regions {
            let largest_m = &mut extents_m[*feature as usize];
            *largest_m = largest_m.max(of_part_m);
        }
    }
    extents_m
}

/// Type of a vertex.
enum Vertex {
    /// In the middle of this flat part.
    Within(u32),
    /// Between these two edges of a straight one.
    Along(u32, u32),
    Corner,
}

/// Type of the vertex that these corners of triangles share.
fn vertex(
    fan: &[(u32, u32, u8)],
    triangles: &[Triangle],
    edges: &Edges,
    part_of: &[u32],
    diagonal: f64,
) -> Vertex {
    let mut outer: Vec<(u32, Vector3<f64>)> = fan
        .iter()
        .flat_map(|&(_, t, k)| {
            let (t, k) = (t as usize, k as usize);
            let corners = &triangles[t].corners;
            let [next, last] = [(k + 1) % 3, (k + 2) % 3];
            [
                (edges.of[t][k], corners[next] - corners[k]),
                (edges.of[t][last], corners[last] - corners[k]),
            ]
        })
        .filter(|(edge, _)| !edges.is_inner(*edge, part_of))
        .collect();
    outer.sort_unstable_by_key(|(edge, _)| *edge);
    outer.dedup_by_key(|(edge, _)| *edge);
    let part = part_of[fan[0].1 as usize];
    match &outer[..] {
        [] if fan.iter().all(|(_, t, _)| part_of[*t as usize] == part) => Vertex::Within(part),
        [(a, to_a), (b, to_b)]
            if edges.parts(*a, part_of) == edges.parts(*b, part_of)
                && are_opposite(to_a, to_b, diagonal) =>
        {
            Vertex::Along(*a, *b)
        }
        _ => Vertex::Corner,
    }
}

/// The flat part of each triangle, and the number of parts. Each grows from its largest triangle
/// over edges, as long as it stays in that plane.
fn flat_parts(triangles: &[Triangle], edges: &Edges, diagonal: f64) -> (Vec<u32>, u32) {
    const NONE: u32 = u32::MAX;
    let sizes: Vec<[f64; 2]> = triangles.iter().map(area_and_height).collect();
    let mut seeds: Vec<u32> = (0..triangles.len() as u32).collect();
    seeds.sort_unstable_by(|a, b| {
        sizes[*b as usize][0]
            .total_cmp(&sizes[*a as usize][0])
            .then(a.cmp(b))
    });
    let mut part_of = vec![NONE; triangles.len()];
    let mut parts = 0;
    let mut open = Vec::new();
    for seed in seeds {
        if part_of[seed as usize] != NONE {
            continue;
        }
        let plane = &triangles[seed as usize];
        let is_in_plane = |t: u32| {
            let triangle = &triangles[t as usize];
            let slack = STRAIGHT + ROUGHNESS * diagonal / sizes[t as usize][1];
            let off = |v: &Vector3<f64>| (v - plane.corners[0]).dot(&plane.normal).abs();
            triangle.normal.cross(&plane.normal).norm() <= slack
                && triangle
                    .corners
                    .iter()
                    .all(|v| off(v) <= ROUGHNESS * diagonal)
        };
        part_of[seed as usize] = parts;
        open.push(seed);
        while let Some(t) = open.pop() {
            for edge in edges.of[t as usize] {
                for &next in edges.triangles(edge) {
                    if part_of[next as usize] == NONE && is_in_plane(next) {
                        part_of[next as usize] = parts;
                        open.push(next);
                    }
                }
            }
        }
        parts += 1;
    }
    (part_of, parts)
}

/// Area, and height above the longest side.
fn area_and_height(triangle: &Triangle) -> [f64; 2] {
    let [a, b, c] = &triangle.corners;
    let twice_area = (b - a).cross(&(c - a)).norm();
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    [0.5 * twice_area, twice_area / longest]
}

/// Whether two edges that leave a vertex are one straight line.
fn are_opposite(a: &Vector3<f64>, b: &Vector3<f64>, diagonal: f64) -> bool {
    let (length_a, length_b) = (a.norm(), b.norm());
    let slack = STRAIGHT + ROUGHNESS * diagonal / length_a.min(length_b);
    a.dot(b) < 0.0 && a.cross(b).norm() <= slack * length_a * length_b
}
