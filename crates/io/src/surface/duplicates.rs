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
/// An even number of equal triangles may also be where two parts touch or overlap, face on face.
/// Where that closes the surface, none is kept of those that stand there both ways round (a wall
/// between the parts), and two of those that stand there one way round.
pub(super) fn drop_superfluous(mesh: &mut Mesh) -> Dropped {
    let all = mesh.triangles.len();
    let (degenerate, kept) = keep_one_of_equal(mesh, NO_HEIGHT);
    let pairs: Vec<Pair> = (0..)
        .zip(&kept)
        .filter(|(_, equal)| equal.count % 2 == 0)
        .map(|(triangle, equal)| Pair {
            triangle,
            both_ways: equal.both_ways,
        })
        .collect();
    if !pairs.is_empty() {
        settle_pairs(mesh, &pairs);
    }
    Dropped {
        degenerate,
        duplicate: all - degenerate - mesh.triangles.len(),
    }
}

/// A set of equal triangles.
pub(super) struct Equal {
    count: usize,
    /// As many stand there one way round as the other.
    pub(super) both_ways: bool,
}

/// Drops triangles no higher than `no_height` (local units) and all but one of each set of equal
/// ones, wound as most of its set are, and sorts the rest by their vertices. How many had no area,
/// and the set of each that is kept.
pub(super) fn keep_one_of_equal(mesh: &mut Mesh, no_height: f64) -> (usize, Vec<Equal>) {
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
        kept.push(Equal {
            count: equal.len(),
            both_ways: 2 * turned == equal.len(),
        });
    }
    (degenerate, kept)
}

/// A triangle that stands there an even number of times.
struct Pair {
    triangle: u32,
    /// As often one way round as the other.
    both_ways: bool,
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

/// Decides for each patch of connected `pairs` of triangles whether one of each is kept, and winds
/// those that stand there both ways like a neighbour.
fn settle_pairs(mesh: &mut Mesh, pairs: &[Pair]) {
    let edges = Edges::of(mesh);
    let place = |h: u32| {
        pairs
            .binary_search_by_key(&(h / 3), |pair| pair.triangle)
            .ok()
    };
    let mut patches = Sets::new(pairs.len());
    for group in edges.groups() {
        let mut members = group.iter().filter_map(|h| place(*h));
        if let Some(first) = members.next() {
            members.for_each(|other| {
                patches.join(first as u32, other as u32, false);
            });
        }
    }
    // Edges of each patch with an odd number of facets when one of each pair is kept, and
    // otherwise.
    let mut odd = vec![[0_usize; 2]; pairs.len()];
    for group in edges.groups() {
        let members: Vec<usize> = group.iter().filter_map(|h| place(*h)).collect();
        if let Some(first) = members.first() {
            let patch = &mut odd[patches.find(*first as u32).0 as usize];
            patch[0] += group.len() % 2;
            patch[1] += (group.len() - members.len()) % 2;
        }
    }
    let both_ways = |h: u32| place(h).is_some_and(|i| pairs[i].both_ways);
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
    for (i, pair) in pairs.iter().enumerate() {
        let [one_kept, otherwise] = odd[patches.find(i as u32).0 as usize];
        if otherwise < one_kept && pair.both_ways {
            dropped[pair.triangle as usize] = true;
        } else if otherwise < one_kept {
            mesh.triangles.push(mesh.triangles[pair.triangle as usize]);
        }
    }
    let mut place = 0;
    mesh.triangles.retain(|_| {
        place += 1;
        place > dropped.len() || !dropped[place - 1]
    });
}
