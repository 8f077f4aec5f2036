//! A packing to be made: the solid, the sizes in its local units, and the starting point of the
//! front.

use super::settings::PackSettings;
use super::solid::Solid;
use crate::front::{Assembly, SizeSettings};
use crate::geometry::inside::is_inside;
use crate::grid::WIDEST_CLASS;
use crate::sizes::Sizes;
use crate::spheres::Vector3;
use dem_io::units::show_length;
use dem_io::{Diagnostic, Result};

/// Number of cells of the front's grid in addition to one per sphere.
const MORE_CELLS: usize = 1_000_000;

/// The job shared by all steps of a packing.
pub(super) struct Job<'a> {
    pub(super) solid: &'a Solid<'a>,
    pub(super) settings: &'a PackSettings,
    /// Starting point of the front, local units.
    pub(super) seed: Vector3,
    /// All radii are multiples of this, about 2e-10 of the largest, so that a radius is the same
    /// number whatever its unit was. A difference in the last bit would grow while the spheres
    /// settle, until every sphere was somewhere else.
    radius_step: f64,
}

impl<'a> Job<'a> {
    /// Checks the settings and makes the job.
    pub(super) fn new(solid: &'a Solid, settings: &'a PackSettings) -> Result<Self> {
        check_sizes_fit(solid, &settings.sizes)?;
        let largest = 0.5 * settings.sizes.max_m() / solid.surface.unit_m;
        Ok(Self {
            solid,
            settings,
            seed: seed_point(solid, settings)?,
            radius_step: (largest.log2().floor() - 32.0).exp2(),
        })
    }

    /// Radius over reduced radius.
    pub(super) fn enlarge(&self) -> f64 {
        1.0 + self.settings.overlap
    }

    /// The largest corner of the box around the solid, whose smallest is the origin.
    pub(super) fn extent(&self) -> Vector3 {
        Vector3::from(self.solid.surface.extent())
    }

    /// Smallest and largest radius as requested, local units.
    pub(super) fn exact_radius_range(&self) -> [f64; 2] {
        let sizes = &self.settings.sizes;
        [sizes.min_m(), sizes.max_m()].map(|d| 0.5 * d / self.solid.surface.unit_m)
    }

    /// The same, rounded like all radii. Where sizes differ much, a step is no small part of the
    /// smallest radius, and rounding leads inwards: no sphere grows by it into another.
    pub(super) fn radius_range(&self) -> [f64; 2] {
        let [smallest, largest] = self.exact_radius_range();
        if largest > WIDEST_CLASS * smallest {
            let steps = [
                (smallest / self.radius_step).ceil(),
                (largest / self.radius_step).floor(),
            ];
            return steps.map(|n| n * self.radius_step);
        }
        [smallest, largest].map(|r| self.rounded(r))
    }

    fn rounded(&self, radius: f64) -> f64 {
        (radius / self.radius_step).round() * self.radius_step
    }

    /// Radius of a quantile of the sizes, local units.
    fn radius(&self, quantile: f64) -> f64 {
        let sizes = &self.settings.sizes;
        let [smallest, largest] = self.radius_range();
        self.rounded(0.5 * sizes.quantile_by_number(quantile) / self.solid.surface.unit_m)
            .clamp(smallest, largest)
    }

    /// An empty assembly for about `expected` spheres, with radii `scale` times those requested,
    /// which are to grow to full size.
    pub(super) fn assembly(&self, scale: f64, wall_factor: f64, expected: usize) -> Assembly<'_> {
        let settings = SizeSettings {
            radius: Box::new(move |quantile| scale * self.radius(quantile)),
            radius_range: self.radius_range().map(|r| scale * r),
            overlap: self.settings.overlap,
            wall_factor,
            most_cells: MORE_CELLS + expected,
        };
        Assembly::new(settings, &self.solid.boundary, &self.extent())
    }
}

fn check_sizes_fit(solid: &Solid, sizes: &Sizes) -> Result<()> {
    let inscribed_m = solid.largest_inscribed_diameter_m();
    let wanted = [
        (sizes.min_m(), "no sphere fits", "smallest"),
        (sizes.max_m(), "the largest spheres fit nowhere", "largest"),
    ];
    for (diameter, problem, which) in wanted {
        if diameter > inscribed_m * (1.0 + 1e-9) {
            return Err(Diagnostic::input(
                solid.surface.source.clone(),
                format!(
                    "{problem}: the largest inscribed sphere has diameter {}, the {which} wanted has {}",
                    show_length(inscribed_m),
                    show_length(diameter)
                ),
                "ask for smaller diameters, or check --unit and --scale",
            ));
        }
    }
    Ok(())
}

fn seed_point(solid: &Solid, settings: &PackSettings) -> Result<Vector3> {
    let Some(given) = settings.seed_point_m else {
        return Ok(solid.deepest.centre);
    };
    let local = solid.to_local(given);
    if is_inside(&solid.boundary, &local) {
        return Ok(local);
    }
    let inside = solid
        .to_metres(&solid.deepest.centre)
        .map(show_length)
        .join(", ");
    Err(Diagnostic::input(
        "--seed-point",
        format!(
            "({}) lies outside the shape",
            given.map(show_length).join(", ")
        ),
        format!("the deepest point inside is ({inside})"),
    ))
}
