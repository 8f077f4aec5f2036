//! Facets that bound nothing: without area, or standing there already.

use super::mesh::{Edges, Mesh, normal, smallest_first};
use super::sets::Sets;

/// A triangle lower than this (local units) has no area.
const NO_HEIGHT: f64 = 1e-12;

/// A loose sliver may hold another one; more than so many layers are not slivers by mistake.
const SLIVER_ROUNDS: usize = 4;

/// What was dropped.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
pub(super) struct Dropped {
    /// Triangles without area.
    pub(super) degenerate: usize,
    /// Triangles that stood there already.
    pub(super) duplicate: usize,
}

/// Drops triangles without area and all but one of each set of equal triangles, and sorts the rest
/// by their vertices.
///
/// Equal triangles may also be where parts touch or overlap, face on face. Where that closes the
/// surface, as many are kept as stand there more often one way round than the other: none of a wall
/// between two parts, all of a face that parts on one side have in common.
pub(super) fn drop_superfluous(mesh: &mut Mesh) -> Dropped {
    let all = mesh.triangles.len();
    let (degenerate, kept) = keep_one_of_equal(mesh, NO_HEIGHT);
    let faces: Vec<CommonFace> = (0..)
        .zip(&kept)
        .filter(|(_, surplus)| **surplus != 1)
        .map(|(triangle, surplus)| CommonFace {
            triangle,
            surplus: *surplus,
        })
        .collect();
    if !faces.is_empty() {
        settle_common_faces(mesh, &faces);
    }
    Dropped {
        degenerate,
        duplicate: all - degenerate - mesh.triangles.len(),
    }
}

/// Drops triangles no higher than `no_height` (local units) and all but one of each set of equal
/// ones, wound as most of its set are, and sorts the rest by their vertices. How many had no area,
/// and for each that is kept how many more of its set stand there one way round than the other.
pub(super) fn keep_one_of_equal(mesh: &mut Mesh, no_height: f64) -> (usize, Vec<usize>) {
    let mut sorted: Vec<([u32; 3], bool)> = (0..mesh.triangles.len() as u32)
        .filter(|t| has_area(mesh, *t, no_height))
        .map(|t| {
            let [a, b, c] = smallest_first(mesh.triangles[t as usize]);
            ([a, b.min(c), b.max(c)], b > c)
        })
        .collect();
    let degenerate = mesh.triangles.len() - sorted.len();
    sorted.sort_unstable();
    mesh.triangles.clear();
    let mut kept = Vec::new();
    for equal in sorted.chunk_by(|x, y| x.0 == y.0) {
        let turned = equal.iter().filter(|(_, turned)| *turned).count();
        let [a, b, c] = equal[0].0;
        mesh.triangles.push(if 2 * turned > equal.len() {
            [a, c, b]
        } else {
            [a, b, c]
        });
        kept.push((2 * turned).abs_diff(equal.len()));
    }
    (degenerate, kept)
}

/// A triangle of more than one part.
struct CommonFace {
    triangle: u32,
    /// How many more of its kind stand there one way round than the other. Not one.
    surplus: usize,
}

fn has_area(mesh: &Mesh, triangle: u32, no_height: f64) -> bool {
    let [a, b, c] = mesh.triangles[triangle as usize];
    a != b && b != c && c != a && height(mesh, triangle) > no_height
}

/// The least height of a triangle.
fn height(mesh: &Mesh, triangle: u32) -> f64 {
    let corners = mesh.corners(triangle);
    let [p, q, r] = corners;
    let longest = (p - q).norm().max((q - r).norm()).max((r - p).norm());
    normal(corners).norm() / longest
}

/// Drops triangles lower than `tolerance` (local units) that hang loose: at least two of their
/// edges have an odd number of facets. In single precision, three corners on a line are seldom
/// exactly so. Returns how many.
pub(super) fn drop_loose_slivers(mesh: &mut Mesh, tolerance: f64) -> usize {
    let before = mesh.triangles.len();
    for _ in 0..SLIVER_ROUNDS {
        let mut odd_edges = vec![0_u8; mesh.triangles.len()];
        for group in Edges::of(mesh)
            .groups()
            .filter(|group| group.len() % 2 == 1)
        {
            group.iter().for_each(|h| odd_edges[*h as usize / 3] += 1);
        }
        let loose = |t: u32| {
            if height(mesh, t) <= tolerance {
                odd_edges[t as usize]
            } else {
                0
            }
        };
        let loosest = (0..mesh.triangles.len() as u32)
            .map(loose)
            .max()
            .unwrap_or(0);
        if loosest < 2 {
            break;
        }
        let kept = (0..mesh.triangles.len() as u32).filter(|t| loose(*t) < loosest);
        mesh.triangles = kept.map(|t| mesh.triangles[t as usize]).collect();
    }
    before - mesh.triangles.len()
}

/// Decides for each patch of connected `faces` whether one of each is kept or its surplus, and
/// winds those that stand there both ways like a neighbour.
fn settle_common_faces(mesh: &mut Mesh, faces: &[CommonFace]) {
    let edges = Edges::of(mesh);
    let place = |h: u32| {
        faces
            .binary_search_by_key(&(h / 3), |face| face.triangle)
            .ok()
    };
    let mut patches = Sets::new(faces.len());
    for group in edges.groups() {
        let mut members = group.iter().filter_map(|h| place(*h));
        if let Some(first) = members.next() {
            members.for_each(|other| {
                patches.join(first as u32, other as u32, false);
            });
        }
    }
    let mut one_kept = vec![Faults::default(); faces.len()];
    let mut surplus_kept = one_kept.clone();
    for group in edges.groups() {
        if let Some(first) = group.iter().find_map(|h| place(*h)) {
            let patch = patches.find(first as u32).0 as usize;
            one_kept[patch].add(mesh, group, |_| 1);
            surplus_kept[patch].add(mesh, group, |h| place(h).map_or(1, |i| faces[i].surplus));
        }
    }
    let both_ways = |h: u32| place(h).is_some_and(|i| faces[i].surplus == 0);
    for group in edges.groups().filter(|group| group.len() == 2) {
        for (this, other) in [(group[0], group[1]), (group[1], group[0])] {
            if both_ways(this) && !both_ways(other) && mesh.half_edge(this) == mesh.half_edge(other)
            {
                mesh.triangles[this as usize / 3].swap(1, 2);
                break;
            }
        }
    }
    let mut dropped = vec![false; mesh.triangles.len()];
    for (i, face) in faces.iter().enumerate() {
        let patch = patches.find(i as u32).0 as usize;
        if surplus_kept[patch] < one_kept[patch] {
            dropped[face.triangle as usize] = face.surplus == 0;
            let corners = mesh.triangles[face.triangle as usize];
            for _ in 1..face.surplus {
                mesh.triangles.push(corners);
            }
        }
    }
    let mut place = 0;
    mesh.triangles.retain(|_| {
        place += 1;
        place > dropped.len() || !dropped[place - 1]
    });
}

/// Edges of a patch that do not close the surface. The fewer odd ones the better, then the fewer
/// against each other.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Faults {
    /// Edges with an odd number of facets.
    odd: usize,
    /// Edges along which more facets run one way than the other.
    unbalanced: usize,
}

impl Faults {
    /// Counts an edge, each facet of which stands there `times`.
    fn add(&mut self, mesh: &Mesh, group: &[u32], times: impl Fn(u32) -> usize) {
        let (mut facets, mut forwards) = (0, 0);
        for h in group {
            let [start, end] = mesh.half_edge(*h);
            facets += times(*h);
            forwards += if start < end { times(*h) } else { 0 };
        }
        self.odd += facets % 2;
        self.unbalanced += usize::from(2 * forwards != facets);
    }
}
