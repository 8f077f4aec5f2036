//! Spheres and points. Lengths in local units of the surface.

/// A point or direction in local units.
pub type Vector3 = nalgebra::Vector3<f64>;

/// The spheres of a packing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Spheres {
    /// Centres. One per sphere.
    pub positions: Vec<[f64; 3]>,
    /// Radii (not reduced by the overlap). One per sphere.
    pub radii: Vec<f64>,
}

/// A sphere while it is packed: centre x, y, z and reduced radius r_gen.
pub type ReducedSphere = [f64; 4];

pub(crate) fn centre_of(sphere: &ReducedSphere) -> Vector3 {
    Vector3::new(sphere[0], sphere[1], sphere[2])
}

pub(crate) fn distance(sphere: &ReducedSphere, point: &Vector3) -> f64 {
    (centre_of(sphere) - point).norm()
}
