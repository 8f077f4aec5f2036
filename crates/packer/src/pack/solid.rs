//! The solid inside a surface, shared by all its packings.

use crate::geometry::boundary::Boundary;
use crate::seed::{InscribedSphere, deepest_point, inner_points};
use crate::spheres::Vector3;
use dem_io::{Diagnostic, Result, Surface};

/// A surface, prepared for packing.
pub(crate) struct Solid<'a> {
    /// The surface; all lengths are in its local units.
    pub(crate) surface: &'a Surface,
    /// Its wall.
    pub(crate) boundary: Boundary,
    /// Points spread over the inside, deepest first.
    pub(crate) inner: Vec<InscribedSphere>,
    /// The largest sphere that fits.
    pub(crate) deepest: InscribedSphere,
}

impl<'a> Solid<'a> {
    /// The solid inside a surface; refuses one without a point inside.
    pub(crate) fn new(surface: &'a Surface) -> Result<Self> {
        let boundary = Boundary::new(surface)?;
        let inner = inner_points(&boundary, surface);
        let deepest = deepest_point(&boundary, surface, &inner).ok_or_else(|| {
            Diagnostic::input(
                surface.source.clone(),
                "no point inside the surface was found",
                "check that it is closed and not flat",
            )
        })?;
        Ok(Self {
            surface,
            boundary,
            inner,
            deepest,
        })
    }

    /// Diameter of the largest sphere that fits, m.
    pub(crate) fn largest_inscribed_diameter_m(&self) -> f64 {
        2.0 * self.deepest.radius * self.surface.unit_m
    }

    /// A local point in metres.
    pub(crate) fn to_metres(&self, point: &Vector3) -> [f64; 3] {
        let surface = self.surface;
        [0, 1, 2].map(|k| surface.origin_m[k] + surface.unit_m * point[k])
    }

    /// A point in metres in local units.
    pub(crate) fn to_local(&self, point_m: [f64; 3]) -> Vector3 {
        let surface = self.surface;
        Vector3::from([0, 1, 2].map(|k| (point_m[k] - surface.origin_m[k]) / surface.unit_m))
    }

    /// Sum of the volumes of spheres of these radii (local units) / volume of the solid.
    pub(crate) fn filled_fraction(&self, radii: impl Iterator<Item = f64>) -> f64 {
        sphere_volumes(radii) * self.surface.unit_m.powi(3) / self.surface.volume_m3()
    }
}

/// Sum of the volumes of spheres of these radii.
pub(super) fn sphere_volumes(radii: impl Iterator<Item = f64>) -> f64 {
    radii
        .map(|r| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
        .sum()
}
