//! The mass of a body of spheres, compared with that of its shape: spheres overlap, and leave
//! voids.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::inertia::{MassProperties, of_spheres};
use super::parts::{About, Body};
use crate::units::{show_length, significant};

/// Coordinates of a centre below this fraction of the radius of gyration are rounding errors.
const ROUNDING: f64 = 1e-9;
/// Largest number of bodies that are listed.
const LISTED: usize = 8;

/// The mass of a body, and that of its shape filled with one density. SI units.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BodyMass {
    /// Mass of its spheres, kg. Overlaps count twice, except for a clump whose mass is that of the
    /// union of its spheres.
    pub mass_kg: f64,
    /// Mass over the volume of its shape, kg/m3, if that volume is known: its solid density.
    pub solid_density_kg_m3: Option<f64>,
    /// The density with which its shape is filled for the comparison, kg/m3, if known.
    pub fill_density_kg_m3: Option<f64>,
    /// Mass of its shape filled with that density, kg, if its volume is known.
    pub shape_mass_kg: Option<f64>,
    /// Difference between its mass and that mass, percent.
    pub difference_percent: Option<f64>,
    /// Centre of mass, m. Length 3.
    pub centre_m: [f64; 3],
    /// Principal moments of inertia about the centre of mass, ascending, kg m2. Length 3.
    pub principal_moments_kg_m2: [f64; 3],
    /// Inertia about the centre of mass along the axes of space, kg m2: a symmetric matrix.
    pub inertia_kg_m2: [[f64; 3]; 3],
}

impl BodyMass {
    /// For a body with these mass properties, and a shape of this volume (m3) to be filled with
    /// this density (kg/m3).
    pub fn new(
        properties: &MassProperties,
        fill_density_kg_m3: Option<f64>,
        shape_volume_m3: Option<f64>,
    ) -> Self {
        let mass_kg = properties.mass_kg;
        let filled = fill_density_kg_m3.zip(shape_volume_m3);
        let shape_mass_kg = filled.map(|(density, volume)| density * volume);
        Self {
            mass_kg,
            solid_density_kg_m3: shape_volume_m3.map(|volume| mass_kg / volume),
            fill_density_kg_m3,
            shape_mass_kg,
            difference_percent: shape_mass_kg.map(|shape| 100.0 * (mass_kg / shape - 1.0)),
            centre_m: properties.centre_m,
            principal_moments_kg_m2: properties.moments_kg_m2,
            inertia_kg_m2: properties.inertia_kg_m2(),
        }
    }

    /// Two human-readable lines: mass, that of its filled shape, and solid density; centre and
    /// principal moments.
    pub fn lines(&self) -> [String; 2] {
        let mut mass = format!("{} kg", significant(self.mass_kg, 4));
        if let (Some(density), Some(shape), Some(percent)) = (
            self.fill_density_kg_m3,
            self.shape_mass_kg,
            self.difference_percent,
        ) {
            mass += &format!(
                "; its shape filled with {} kg/m3 would weigh {} kg ({})",
                significant(density, 4),
                significant(shape, 4),
                percent_text(percent)
            );
        }
        if let Some(solid) = self.solid_density_kg_m3 {
            mass += &format!("; solid density {} kg/m3", significant(solid, 4));
        }
        let moments = self.principal_moments_kg_m2;
        let centre = format!(
            "centre {}; {}",
            centre_text(self.centre_m, moments, self.mass_kg),
            moments_text(moments)
        );
        [mass, centre]
    }
}

/// A human-readable centre of mass: rounding errors are shown as 0.
pub(crate) fn centre_text(centre_m: [f64; 3], moments_kg_m2: [f64; 3], mass_kg: f64) -> String {
    let sum: f64 = moments_kg_m2.iter().sum();
    let least_m = ROUNDING * (0.5 * sum / mass_kg).sqrt();
    let shown = |x: f64| show_length(if x.abs() < least_m { 0.0 } else { x });
    centre_m.map(shown).join(", ")
}

/// Human-readable principal moments.
pub(crate) fn moments_text(moments_kg_m2: [f64; 3]) -> String {
    let moments = moments_kg_m2.map(|moment| significant(moment, 4));
    format!("principal moments {} kg m2", moments.join(", "))
}

/// A human-readable difference: -21 %, +4.1 %.
pub fn percent_text(percent: f64) -> String {
    match percent.abs() {
        none if none < 0.05 => "as much".to_owned(),
        few if few < 9.95 => format!("{percent:+.1} %"),
        _ => format!("{percent:+.0} %"),
    }
}

/// Mass properties of a body whose spheres have this density, kg/m3.
pub fn of_body(body: &Body, density_kg_m3: f64) -> MassProperties {
    let radii = body.radii.iter();
    let masses: Vec<f64> = radii.map(|r| density_kg_m3 * volume_m3(*r)).collect();
    let pairs = masses.iter().zip(&body.radii);
    let inertias: Vec<f64> = pairs.map(|(mass, r)| 0.4 * mass * r * r).collect();
    of_spheres(&body.positions, &masses, &inertias)
}

/// The mass of a body whose spheres have the density that it names. None if it names none.
pub fn of_named_density(body: &Body) -> Option<BodyMass> {
    let About {
        particle_density_kg_m3: density,
        shape_volume_m3: volume,
        ..
    } = body.about;
    density.map(|density| BodyMass::new(&of_body(body, density), Some(density), volume))
}

/// Volume of a sphere of this radius, m3.
pub fn volume_m3(radius_m: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius_m * radius_m * radius_m
}

/// Human-readable lines for bodies by name, the first preceded by a label: two for each body.
pub fn mass_lines(masses: &BTreeMap<String, BodyMass>) -> Vec<(&'static str, String)> {
    let mut lines = Vec::new();
    for (name, mass) in masses.iter().take(LISTED) {
        let head = if lines.is_empty() { "mass" } else { "" };
        let [mass, centre] = mass.lines();
        lines.push((head, format!("{name} {mass}")));
        lines.push(("", format!("  {centre}")));
    }
    if masses.len() > LISTED {
        lines.push(("", format!("... ({} bodies in all)", masses.len())));
    }
    lines
}
