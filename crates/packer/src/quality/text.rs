//! The human-readable report.

use super::densities::{Fraction, Layer};
use super::fabric::Fabric;
use super::report::Report;
use super::warnings::RARE;
use crate::sizes::Fit;
use dem_io::units::{show_length, significant};

/// Noise of an eigenvalue of a fabric above which chance explains nearly any of them: of 35 bonds
/// and fewer.
const MOST_NOISE: f64 = 0.05;

/// A name and its text.
type Line = (&'static str, String);

impl Report {
    /// The human-readable report: about twenty aligned lines, one subject each.
    pub fn text(&self) -> String {
        let lines: Vec<Line> = density_lines(self)
            .into_iter()
            .chain(profile_lines(self))
            .chain([
                ("sizes by number", fit(&self.sizes_by_number)),
                ("sizes by mass", fit(&self.sizes_by_mass)),
            ])
            .chain(bond_lines(self))
            .chain(structure_lines(self))
            .collect();
        let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let line = |(name, what): &Line| format!("{name:width$}  {what}\n");
        lines.iter().map(line).collect()
    }

    /// What the line "packing density" of the report says.
    pub(crate) fn packing_density(&self) -> String {
        format!(
            "{} of the shape is inside spheres, {:.4} at the reduced radii r_gen",
            with_error(&self.union_density),
            self.generating_density
        )
    }
}

/// Number and sizes of the particles, and how densely they fill the solid.
fn density_lines(report: &Report) -> Vec<Line> {
    let particles = format!(
        "{}, mean diameter {}, overlap {}",
        report.particles,
        show_length(report.mean_diameter_m),
        significant(report.overlap, 4)
    );
    let mut lines = vec![("particles", particles)];
    if let Some(density) = report.solid_density_kg_m3 {
        lines.push((
            "solid density",
            format!("{} kg/m3", significant(density, 4)),
        ));
    }
    lines.push(("packing density", report.packing_density()));
    let depth = show_length(report.interior_depth_m);
    let interior = report.interior_union_density.as_ref();
    let interior = match interior.zip(report.interior_generating_density.as_ref()) {
        Some((union, generating)) => format!(
            "{}, {} in r_gen, deeper than {depth}",
            with_error(union),
            with_error(generating),
        ),
        None => format!("none: nowhere deeper than {depth}"),
    };
    lines.push(("interior", interior));
    lines
}

/// Density profiles from the wall inwards and along the shape.
fn profile_lines(report: &Report) -> Vec<Line> {
    let densities = |layers: &[Layer]| {
        let values: Vec<String> = layers.iter().map(|l| value(l.density.as_ref())).collect();
        values.join(" ")
    };
    // The first two diameters, where it changes; the complete profile is in the JSON.
    let near = &report.wall_profile[..report.wall_profile.len().min(8)];
    let near = format!("{} per quarter diameter, r_gen", densities(near));
    let mut lines = vec![("from the wall", near)];
    if report.interior_generating_density.is_some() {
        let along = format!("{} interior, r_gen", densities(&report.slab_profile));
        lines.push(("along the shape", along));
    }
    lines
}

/// Bonds and contacts.
fn bond_lines(report: &Report) -> [Line; 4] {
    let contacts = &report.contacts;
    let up_to = if report.bond_range > 0.0 {
        format!(" up to bond range {}", significant(report.bond_range, 5))
    } else {
        String::new()
    };
    let bonds = format!(
        "{}{up_to}, {} per particle, coordination number {}",
        report.bonds,
        significant(report.bonds_per_particle, 4),
        significant(report.mean_coordination, 4)
    );
    let touching = format!(
        "{} per particle within {} of a radius, {} at the wall, {:.1} % rattlers",
        significant(contacts.per_particle, 4),
        significant(contacts.gap_limit, 2),
        contacts.at_wall,
        100.0 * contacts.rattlers
    );
    let exactness = format!(
        "largest overlap at r_gen {}, largest protrusion through the wall {}",
        of_a_radius(contacts.largest_overlap),
        of_a_radius(contacts.largest_protrusion)
    );
    let pieces = &report.pieces;
    let in_pieces = format!(
        "{}, the largest with {:.2} % of the particles; {} particles with one bond, {} unbonded",
        pieces.count,
        100.0 * pieces.largest_fraction,
        pieces.with_one_bond,
        pieces.without_bond
    );
    [
        ("bonds", bonds),
        ("contacts", touching),
        ("exactness", exactness),
        ("pieces", in_pieces),
    ]
}

/// Directions of the bonds, and the thinnest part.
fn structure_lines(report: &Report) -> Vec<Line> {
    let mut lines = Vec::new();
    // Near a wall the layers show, which are not a preferred direction of the material.
    match (&report.interior_fabric, &report.fabric) {
        (Some(interior), _) => lines.push(("fabric inside", fabric(interior))),
        (None, Some(all)) => lines.push((
            "fabric",
            format!("{}; includes the layers along the wall", fabric(all)),
        )),
        (None, None) => {}
    }
    if let Some(thinnest) = &report.thinnest {
        let about = if thinnest.at_least {
            "at least"
        } else {
            "about"
        };
        let across = format!(
            "{about} {} particles across ({})",
            significant(thinnest.particles_across, 2),
            show_length(thinnest.thickness_m)
        );
        lines.push(("thinnest part", across));
    }
    lines
}

fn with_error(fraction: &Fraction) -> String {
    format!("{:.4} +- {:.4}", fraction.value, fraction.error)
}

fn value(fraction: Option<&Fraction>) -> String {
    fraction.map_or_else(|| "-".to_owned(), |f| format!("{:.3}", f.value))
}

fn fit(fit: &Fit) -> String {
    let verdict = if fit.passes() { "" } else { ", exceeded" };
    format!(
        "KS distance {:.4} (95 % limit {:.4}{verdict})",
        fit.distance, fit.limit_95
    )
}

/// The eigenvalues of a fabric, and whether chance explains them.
pub(super) fn fabric(fabric: &Fabric) -> String {
    let [a, b, c] = fabric.eigenvalues;
    let verdict = if fabric.chance < RARE {
        "anisotropic"
    } else if fabric.sigma > MOST_NOISE {
        "too few bonds to tell whether isotropic"
    } else {
        "isotropic"
    };
    format!(
        "eigenvalues {a:.4} {b:.4} {c:.4}: {verdict} (p = {})",
        probability(fabric.chance)
    )
}

fn of_a_radius(fraction: f64) -> String {
    if fraction > 0.0 {
        format!("{fraction:.1e} of a radius")
    } else {
        "none".to_owned()
    }
}

fn probability(chance: f64) -> String {
    if chance < 1e-4 {
        "below 0.0001".to_owned()
    } else {
        significant(chance, 2)
    }
}
