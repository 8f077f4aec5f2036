//! Which facets belong together, and which way round.

use super::mesh::{Edges, Mesh};
use super::sets::Sets;
use std::f64::consts::TAU;

/// The connected parts of a mesh.
pub(super) struct Connected {
    /// Triangles of each part, ascending; parts in the order of their first triangle.
    pub(super) parts: Vec<Vec<u32>>,
    /// Which triangles must be turned so that all of a part are wound alike. The first of each part
    /// is not.
    pub(super) turned: Vec<bool>,
}

/// Finds the parts connected over shared edges, and the triangles that are wound against their
/// neighbours. Edges with one facet or another odd number connect nothing.
///
/// Where four or more facets meet in an edge, two or more parts touch there: each part is continued
/// over the edge by itself where it can be, and otherwise facets are paired that lie next to each
/// other around the edge.
///
/// # Errors
/// The half-edge where no winding of the triangles fits.
pub(super) fn connect(mesh: &Mesh, edges: &Edges) -> Result<Connected, u32> {
    let mut sets = Sets::new(mesh.triangles.len());
    for group in edges.groups().filter(|group| group.len() == 2) {
        join(mesh, &mut sets, group[0], group[1])?;
    }
    for group in edges
        .groups()
        .filter(|group| group.len() > 2 && group.len() % 2 == 0)
    {
        pair(mesh, &mut sets, group)?;
    }
    let mut part_of_root = vec![u32::MAX; mesh.triangles.len()];
    let mut connected = Connected {
        parts: Vec::new(),
        turned: Vec::with_capacity(mesh.triangles.len()),
    };
    for triangle in 0..mesh.triangles.len() as u32 {
        let (root, turned) = sets.find(triangle);
        if root == triangle {
            part_of_root[root as usize] = connected.parts.len() as u32;
            connected.parts.push(Vec::new());
        }
        connected.parts[part_of_root[root as usize] as usize].push(triangle);
        connected.turned.push(turned);
    }
    Ok(connected)
}

/// Joins the triangles of two half-edges of the same edge: wound alike, one runs against the other.
///
/// # Errors
/// The first half-edge, if the two are joined already and the other way.
pub(super) fn join(mesh: &Mesh, sets: &mut Sets, a: u32, b: u32) -> Result<(), u32> {
    let turned = mesh.half_edge(a) == mesh.half_edge(b);
    if sets.join(a / 3, b / 3, turned) {
        Ok(())
    } else {
        Err(a)
    }
}

/// Pairs the half-edges of an edge with an even number of facets, four or more.
fn pair(mesh: &Mesh, sets: &mut Sets, group: &[u32]) -> Result<(), u32> {
    let left = without_closed_parts(mesh, sets, group);
    if left.is_empty() {
        return Ok(());
    }
    let around = sorted_around_edge(mesh, &left);
    let pairs = |first: usize| {
        (first..around.len())
            .step_by(2)
            .map(|i| (around[i], around[(i + 1) % around.len()]))
            .collect::<Vec<_>>()
    };
    // Pairs that are wound alike are better, then the narrowest.
    let mut choices = [pairs(0), pairs(1)].map(|pairs| {
        let against = pairs
            .iter()
            .filter(|(a, b)| mesh.half_edge(a.1) == mesh.half_edge(b.1))
            .count();
        let narrowest = pairs
            .iter()
            .map(|(a, b)| (b.0 - a.0).rem_euclid(TAU))
            .fold(f64::INFINITY, f64::min);
        (against, narrowest, pairs)
    });
    choices.sort_by(|p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)));
    let nested = if choices[0].0 > 0 {
        nested_pairs(mesh, &around)
    } else {
        None
    };
    for pairs in nested
        .into_iter()
        .chain(choices.into_iter().map(|(_, _, pairs)| pairs))
    {
        if pairs.iter().all(|(a, b)| may_join(mesh, sets, a.1, b.1)) {
            return pairs
                .iter()
                .try_for_each(|(a, b)| join(mesh, sets, a.1, b.1));
        }
    }
    Err(group[0])
}

/// A half-edge and the angle of its triangle around the edge, rad.
type AtAngle = (f64, u32);

/// Pairs of half-edges that run against each other, none of which crosses another: the wedges of
/// solids that lie within each other. None: more half-edges run one way than the other.
fn nested_pairs(mesh: &Mesh, around: &[AtAngle]) -> Option<Vec<(AtAngle, AtAngle)>> {
    let forwards = |h: u32| {
        let [start, end] = mesh.half_edge(h);
        start < end
    };
    // The first of a pair runs forwards: begin where the most wedges have ended.
    let (mut depth, mut lowest, mut first) = (0_i32, 0, 0);
    for (i, (_, h)) in around.iter().enumerate() {
        depth += if forwards(*h) { 1 } else { -1 };
        if depth < lowest {
            (lowest, first) = (depth, i + 1);
        }
    }
    if depth != 0 {
        return None;
    }
    let (mut open, mut pairs) = (Vec::new(), Vec::new());
    for i in first..first + around.len() {
        let this = around[i % around.len()];
        if forwards(this.1) {
            open.push(this);
        } else {
            pairs.push((open.pop()?, this));
        }
    }
    Some(pairs)
}

/// Whether two half-edges of the same edge can be joined as things stand.
fn may_join(mesh: &Mesh, sets: &mut Sets, a: u32, b: u32) -> bool {
    let (root_a, turned_a) = sets.find(a / 3);
    let (root_b, turned_b) = sets.find(b / 3);
    root_a != root_b || (mesh.half_edge(a) == mesh.half_edge(b)) == (turned_a != turned_b)
}

/// The half-edges whose part does not run along the edge as often forwards as backwards already.
fn without_closed_parts(mesh: &Mesh, sets: &mut Sets, group: &[u32]) -> Vec<u32> {
    let mut left: Vec<(u32, bool, u32)> = group
        .iter()
        .map(|h| {
            let (root, turned) = sets.find(h / 3);
            let [start, end] = mesh.half_edge(*h);
            (root, (start < end) != turned, *h)
        })
        .collect();
    left.sort_unstable();
    let parts = left
        .chunk_by(|a, b| a.0 == b.0)
        .filter(|part| 2 * part.iter().filter(|(_, forwards, _)| *forwards).count() != part.len());
    parts.flatten().map(|(_, _, h)| *h).collect()
}

/// Half-edges of one edge with the angle of their triangles around it, sorted by it.
fn sorted_around_edge(mesh: &Mesh, group: &[u32]) -> Vec<AtAngle> {
    let [a, b] = mesh.half_edge(group[0]);
    let [start, end] = [a.min(b), a.max(b)].map(|v| mesh.vertices[v as usize]);
    let axis = (end - start).normalize();
    let across = |h: u32| {
        let opposite = mesh.triangles[h as usize / 3][(h as usize + 2) % 3];
        mesh.vertices[opposite as usize] - start
    };
    let y = axis.cross(&across(group[0])).normalize();
    let x = y.cross(&axis);
    let mut around: Vec<AtAngle> = group
        .iter()
        .map(|h| {
            let to = across(*h);
            (to.dot(&y).atan2(to.dot(&x)).rem_euclid(TAU), *h)
        })
        .collect();
    around.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
    around
}
