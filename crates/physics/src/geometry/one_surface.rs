//! Which contact points of a sphere stand for one surface: those of walls that meet, and those of
//! the facets of a rough one.
//!
//! The nearest point of a surface stands for it. Another point belongs to the same surface if it is
//! seen from the centre in nearly the same direction, or if it is on an edge, in a corner or on a
//! round side and stands out from the surface by no more than a small fraction of the radius. Faces
//! in other directions are surfaces of their own, so that both sides of a groove push, unless their
//! points are buried.

use nalgebra::Vector3;

use super::touch::Touch;

/// Cosine of the angle between the normals of faces that count as one: 8 degrees.
pub const ALIKE: f64 = 0.99;

/// An edge that stands out from a face by no more than this fraction of the radius belongs to it:
/// as much as two faces that count as one differ.
const STANDS_OUT: f64 = 0.01;

/// Cosine of the angle within which points on facets smaller than the sphere count as one: 26
/// degrees, the half width of a contact whose overlap is a tenth of the radius.
pub const ROUGH: f64 = 0.9;

/// A touch, and what it is on.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    /// Where the sphere touches.
    pub touch: Touch,
    /// On a flat part, not on an edge, in a corner or on a round side.
    pub is_flat: bool,
    /// On a part whose flat surfaces are all smaller than the radius of the sphere.
    pub is_fine: bool,
}

/// Whether a touch belongs to the same surface as one that is at least as near to the centre of a
/// sphere of `radius_m`. Both are given in the same frame.
pub fn is_one(nearer: &Place, other: &Place, radius_m: f64) -> bool {
    let [n, m] = [nearer, other].map(|place| Vector3::from(place.touch.normal));
    let cosine = n.dot(&m);
    if cosine > ALIKE || (nearer.is_fine && other.is_fine && cosine > ROUGH) {
        return true;
    }
    // The normals point into the wall. What is below the plane of a nearer face is buried there.
    let between = Vector3::from(nearer.touch.point) - Vector3::from(other.touch.point);
    match (nearer.is_flat, other.is_flat) {
        (true, true) => between.dot(&n) <= 0.0,
        (false, true) => -between.dot(&m) <= STANDS_OUT * radius_m,
        (_, false) => between.dot(&n) <= STANDS_OUT * radius_m,
    }
}
