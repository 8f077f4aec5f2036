//! The union of the parts of a surface that cross each other: the part of a facet that lies inside
//! another part is not a wall.
//!
//! A facet is split along the segments in which others meet it, into convex pieces that each lie
//! entirely inside or entirely outside every part. A piece is wall if the solid lies behind it and
//! not before it, by the winding numbers on both sides of its middle. If these do not decide (parts
//! that touch with their outer sides), the piece is kept: a superfluous wall is harmless, a hole is
//! not.

use super::tree::{Corners, TriangleTree};
use super::winding::winding;
use crate::spheres::Vector3;
use dem_io::Surface;
use rayon::prelude::*;

/// Lengths below this are rounding errors (local units).
const ROUNDING: f64 = 1e-12;
/// Distance from a piece at which the winding number is evaluated, in local units. Surfaces closer
/// together are taken to coincide.
const OFF: f64 = 1e-7;
/// Facets with more segments than this are halved first, so that the pieces have few corners.
const MANY_SEGMENTS: usize = 8;

type Segment = [Vector3; 2];
type Polygon = Vec<Vector3>;

/// The corners of the triangles that bound the union, in local units. `facets` is the tree over the
/// surface.
pub fn outer_pieces(surface: &Surface, facets: &TriangleTree) -> Vec<Corners> {
    let segments: Vec<Vec<Segment>> = (0..surface.triangles.len())
        .into_par_iter()
        .map(|facet| segments_on(surface, facets, facet))
        .collect();
    let patches = patches(surface, &segments);
    let whole: Vec<usize> = patches
        .into_par_iter()
        .filter(|patch| {
            // The largest facet gives the most reliable side for the patch.
            let facet = patch.iter().copied().max_by(|a, b| {
                let area = |f: usize| normal(surface.corners(f)).norm();
                area(*a).total_cmp(&area(*b)).then(b.cmp(a))
            });
            facet
                .is_some_and(|f| bounds_solid(facets, &corners(surface, f), &normal_of(surface, f)))
        })
        .flatten()
        .collect();
    let cut: Vec<Corners> = segments
        .into_par_iter()
        .enumerate()
        .filter(|(_, segments)| !segments.is_empty())
        .flat_map_iter(|(facet, segments)| {
            let normal = normal_of(surface, facet);
            split(corners(surface, facet), segments, &normal)
                .into_iter()
                .filter(|piece| bounds_solid(facets, piece, &normal))
                .flat_map(triangles)
                .collect::<Vec<_>>()
        })
        .collect();
    let whole = whole.into_iter().map(|facet| surface.corners(facet));
    whole.chain(cut).collect()
}

fn corners(surface: &Surface, facet: usize) -> Polygon {
    surface.corners(facet).map(Vector3::from).to_vec()
}

/// Normal of a triangle; its length is twice the area.
fn normal(corners: Corners) -> Vector3 {
    let [a, b, c] = corners.map(Vector3::from);
    (b - a).cross(&(c - a))
}

/// Unit normal of a facet; zero if it has no area.
fn normal_of(surface: &Surface, facet: usize) -> Vector3 {
    normal(surface.corners(facet))
        .try_normalize(0.0)
        .unwrap_or_default()
}

/// The segments in which other facets meet this one, except along an edge that they share.
fn segments_on(surface: &Surface, facets: &TriangleTree, facet: usize) -> Vec<Segment> {
    let polygon = corners(surface, facet);
    let normal = normal_of(surface, facet);
    let own = surface.triangles[facet];
    let mut segments = Vec::new();
    for other in facets.beside(facet as u32) {
        let other = other as usize;
        let shared = surface.triangles[other]
            .iter()
            .filter(|v| own.contains(v))
            .count();
        if shared < 2 {
            meet(&polygon, &normal, surface.corners(other), &mut segments);
        }
    }
    segments
}

/// Adds the segments in which a triangle meets a polygon.
fn meet(polygon: &Polygon, normal: &Vector3, triangle: Corners, segments: &mut Vec<Segment>) {
    let triangle = triangle.map(Vector3::from);
    let heights = triangle.map(|p| flushed((p - polygon[0]).dot(normal)));
    let mut add = |segment: Segment| {
        if length_within(polygon, normal, &segment) > ROUNDING {
            segments.push(segment);
        }
    };
    let edges = [(0, 1), (1, 2), (2, 0)];
    if heights == [0.0; 3] {
        edges
            .into_iter()
            .for_each(|(i, j)| add([triangle[i], triangle[j]]));
        return;
    }
    let corners = (0..3).filter(|i| heights[*i] == 0.0).map(|i| triangle[i]);
    let crossings = edges
        .into_iter()
        .filter(|(i, j)| heights[*i] * heights[*j] < 0.0)
        .map(|(i, j)| along(triangle[i], triangle[j], heights[i], heights[j]));
    let ends: Vec<Vector3> = corners.chain(crossings).collect();
    if let [start, end] = ends[..] {
        add([start, end]);
    }
}

/// Zero for lengths that are only rounding errors.
fn flushed(length: f64) -> f64 {
    if length.abs() <= ROUNDING {
        0.0
    } else {
        length
    }
}

/// The point between two where a height, given at both with opposite signs, is zero.
fn along(from: Vector3, to: Vector3, height_from: f64, height_to: f64) -> Vector3 {
    from + (to - from) * (height_from / (height_from - height_to))
}

/// Length of the part of a segment that lies inside a convex polygon in the same plane.
fn length_within(polygon: &Polygon, normal: &Vector3, [start, end]: &Segment) -> f64 {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in 0..polygon.len() {
        let corner = polygon[k];
        let edge = polygon[(k + 1) % polygon.len()] - corner;
        let Some(inward) = normal.cross(&edge).try_normalize(0.0) else {
            continue;
        };
        // A segment that runs along the edge lies in the polygon.
        let [before, after] = [start, end].map(|p| (p - corner).dot(&inward) + ROUNDING);
        if before < 0.0 && after < 0.0 {
            return 0.0;
        } else if before < 0.0 {
            from = from.max(before / (before - after));
        } else if after < 0.0 {
            to = to.min(before / (before - after));
        }
    }
    (to - from).max(0.0) * (end - start).norm()
}

/// The facets that no other facet crosses, joined over edges of two facets: a patch is either all
/// wall or not wall at all.
fn patches(surface: &Surface, segments: &[Vec<Segment>]) -> Vec<Vec<usize>> {
    let mut edges: Vec<([u32; 2], usize)> = Vec::new();
    for (facet, triangle) in surface.triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            edges.push(([a.min(b), a.max(b)], facet));
        }
    }
    edges.sort_unstable();
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); surface.triangles.len()];
    for edge in edges.chunk_by(|x, y| x.0 == y.0) {
        if let [(_, a), (_, b)] = *edge {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
    }
    let mut seen: Vec<bool> = segments.iter().map(|s| !s.is_empty()).collect();
    let mut patches = Vec::new();
    for first in 0..seen.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let mut patch = vec![first];
        let mut next = 0;
        while next < patch.len() {
            for &neighbour in &neighbours[patch[next]] {
                if !std::mem::replace(&mut seen[neighbour], true) {
                    patch.push(neighbour);
                }
            }
            next += 1;
        }
        patches.push(patch);
    }
    patches
}

/// Cuts a convex polygon into convex pieces that no segment runs through.
fn split(polygon: Polygon, segments: Vec<Segment>, normal: &Vector3) -> Vec<Polygon> {
    let mut pieces = Vec::new();
    let mut open = vec![(polygon, segments)];
    while let Some((polygon, segments)) = open.pop() {
        let within = |piece: &Polygon| -> Vec<Segment> {
            let lies_in = |s: &&Segment| length_within(piece, normal, s) > ROUNDING;
            segments.iter().filter(lies_in).copied().collect()
        };
        let parts = |[one, other]: [Polygon; 2]| {
            let segments = [within(&one), within(&other)];
            [one, other].into_iter().zip(segments)
        };
        if segments.len() > MANY_SEGMENTS
            && let Some(halves) = divide(&polygon, &middle_line(&segments, normal), normal)
        {
            let halves: Vec<(Polygon, Vec<Segment>)> = parts(halves).collect();
            if halves.iter().all(|half| half.1.len() < segments.len()) {
                open.extend(halves);
                continue;
            }
        }
        match segments.iter().find_map(|s| divide(&polygon, s, normal)) {
            Some(halves) => open.extend(parts(halves)),
            None => pieces.push(polygon),
        }
    }
    pieces
}

/// A line through the middle of some segments, perpendicular to the direction in which they spread
/// most.
fn middle_line(segments: &[Segment], normal: &Vector3) -> Segment {
    let middles = || segments.iter().map(|[p, q]| 0.5 * (p + q));
    let middle = middles().sum::<Vector3>() / segments.len() as f64;
    let farthest = middles()
        .map(|p| p - middle)
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        .unwrap_or_default();
    [middle, middle + normal.cross(&farthest)]
}

/// The two parts of a convex polygon on both sides of the line through a segment in its plane;
/// `None` if all lies on one side.
fn divide(polygon: &Polygon, [start, end]: &Segment, normal: &Vector3) -> Option<[Polygon; 2]> {
    let across = normal.cross(&(end - start)).try_normalize(0.0)?;
    let heights: Vec<f64> = polygon
        .iter()
        .map(|p| flushed((p - start).dot(&across)))
        .collect();
    if !(heights.iter().any(|h| *h > 0.0) && heights.iter().any(|h| *h < 0.0)) {
        return None;
    }
    let [mut left, mut right] = [Polygon::new(), Polygon::new()];
    for k in 0..polygon.len() {
        let (corner, height) = (polygon[k], heights[k]);
        let next = (k + 1) % polygon.len();
        if height >= 0.0 {
            left.push(corner);
        }
        if height <= 0.0 {
            right.push(corner);
        }
        if height * heights[next] < 0.0 {
            let crossing = along(corner, polygon[next], height, heights[next]);
            left.push(crossing);
            right.push(crossing);
        }
    }
    Some([left, right])
}

/// True if the solid lies behind a piece of a facet and not before it. Also true if that cannot be
/// decided.
fn bounds_solid(facets: &TriangleTree, piece: &Polygon, normal: &Vector3) -> bool {
    let middle = piece.iter().sum::<Vector3>() / piece.len() as f64;
    let behind = winding(facets, &(middle - OFF * normal));
    let before = winding(facets, &(middle + OFF * normal));
    match (behind, before) {
        (Some(behind), Some(before)) if behind > before => behind > 0 && before <= 0,
        _ => true,
    }
}

/// The triangles of a convex polygon, except those without area.
fn triangles(polygon: Polygon) -> impl Iterator<Item = Corners> {
    (2..polygon.len())
        .map(move |k| [polygon[0], polygon[k - 1], polygon[k]])
        .filter(|[a, b, c]| {
            let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
            (b - a).cross(&(c - a)).norm() > 0.1 * ROUNDING * longest
        })
        .map(|corners| corners.map(Into::into))
}
