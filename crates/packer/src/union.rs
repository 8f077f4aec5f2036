//! Surfaces whose parts cross each other bound the union of the parts: what of a facet lies inside another part is no wall.
//!
//! Facets that come near others are cut into quarters until the pieces are clear of them or very small. A piece whose outer side
//! is inside the solid is left out. What is left is the boundary of the union and, along the lines of crossing, strips of it that reach
//! inwards by at most `FINEST` of the largest extent.

use crate::Vector3;
use crate::boundary::Boundary;
use crate::inside::contains;
use dem_io::Surface;
use rayon::prelude::*;

/// Pieces are not cut any further below this share of the largest extent.
const FINEST: f64 = 1.0 / 256.0;
/// How far off a piece its outer side is looked at, in local units.
const OFF: f64 = 1e-7;

type Corners = [Vector3; 3];

/// The corners of the pieces of all facets that bound the union.
pub fn outer_pieces(surface: &Surface, whole: &Boundary) -> Vec<[[f64; 3]; 3]> {
    let pieces: Vec<Vec<Corners>> = (0..surface.triangles.len())
        .into_par_iter()
        .map(|facet| {
            let mut kept = Vec::new();
            cut(
                surface,
                whole,
                facet,
                surface.corners(facet).map(Vector3::from),
                &mut kept,
            );
            kept
        })
        .collect();
    pieces
        .into_iter()
        .flatten()
        .map(|corners| corners.map(Into::into))
        .collect()
}

fn cut(
    surface: &Surface,
    whole: &Boundary,
    facet: usize,
    corners: Corners,
    kept: &mut Vec<Corners>,
) {
    let [a, b, c] = corners;
    let middle = (a + b + c) / 3.0;
    let reach = corners
        .iter()
        .map(|p| (p - middle).norm())
        .fold(0.0, f64::max);
    let own = surface.triangles[facet];
    let is_near = |other: u32| {
        let shares_corner = surface.triangles[other as usize]
            .iter()
            .any(|v| own.contains(v));
        !shares_corner && whole.nearest_on(other, &middle).distance <= reach
    };
    let is_clear = !whole.triangles_near(&middle, reach).any(is_near);
    if !is_clear && reach > FINEST * surface.extent().into_iter().fold(0.0, f64::max) {
        let (ab, bc, ca) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
        for quarter in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            cut(surface, whole, facet, quarter, kept);
        }
        return;
    }
    let outward = (b - a)
        .cross(&(c - a))
        .try_normalize(0.0)
        .unwrap_or_default();
    if !(is_clear && contains(whole, surface, &(middle + OFF * outward))) {
        kept.push(corners);
    }
}
