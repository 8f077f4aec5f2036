//! The report for a person.

use super::{Fabric, Report, Share};
use crate::sizes::Fit;
use dem_io::units::{show_length, significant};

/// The report, one subject a line, the names aligned.
pub(super) fn of(report: &Report) -> String {
    let mut lines: Vec<(&str, String)> = Vec::new();
    let contacts = &report.contacts;
    lines.push((
        "particles",
        format!(
            "{}, mean diameter {}, overlap {}",
            report.particles,
            show_length(report.mean_diameter_m),
            significant(report.overlap, 4)
        ),
    ));
    if let Some(density) = report.solid_density_kg_m3 {
        lines.push((
            "solid density",
            format!("{} kg/m3", significant(density, 4)),
        ));
    }
    lines.push((
        "packing density",
        format!(
            "{} of the shape is inside spheres, {:.4} in r_gen",
            share(&report.union_density),
            report.generating_density
        ),
    ));
    lines.push((
        "interior",
        match (
            &report.interior_union_density,
            &report.interior_generating_density,
        ) {
            (Some(union), Some(generating)) => {
                format!(
                    "{}, {} in r_gen, deeper than {}",
                    share(union),
                    share(generating),
                    show_length(report.interior_depth_m)
                )
            }
            _ => format!(
                "none: nowhere deeper than {}",
                show_length(report.interior_depth_m)
            ),
        },
    ));
    // The first two diameters, where it changes; the whole profile is in the JSON.
    let near: Vec<String> = report
        .wall_profile
        .iter()
        .take(8)
        .map(|l| value(l.density.as_ref()))
        .collect();
    lines.push((
        "from the wall",
        format!("{} per quarter diameter, r_gen", near.join(" ")),
    ));
    let along: Vec<String> = report
        .slab_profile
        .iter()
        .map(|l| value(l.density.as_ref()))
        .collect();
    if report.interior_generating_density.is_some() {
        lines.push((
            "along the shape",
            format!("{} interior, r_gen", along.join(" ")),
        ));
    }
    lines.push(("sizes by number", fit(&report.sizes_by_number)));
    lines.push(("sizes by mass", fit(&report.sizes_by_mass)));
    lines.push((
        "bonds",
        format!(
            "{}{}, {} per particle, coordination {}",
            report.bonds,
            if report.bonding_radius > 0.0 {
                format!(
                    " up to bonding radius {}",
                    significant(report.bonding_radius, 5)
                )
            } else {
                String::new()
            },
            significant(report.bonds_per_particle, 4),
            significant(report.mean_coordination, 4)
        ),
    ));
    lines.push((
        "contacts",
        format!(
            "{} per particle within {} of a radius, {} at the wall, {:.1} % rattlers",
            significant(contacts.per_particle, 4),
            significant(contacts.gap_limit, 2),
            contacts.at_wall,
            100.0 * contacts.rattlers
        ),
    ));
    lines.push((
        "exactness",
        format!(
            "overlap in r_gen {}, outside the wall {}",
            of_a_radius(contacts.largest_overlap),
            of_a_radius(contacts.largest_protrusion)
        ),
    ));
    let pieces = &report.pieces;
    lines.push((
        "pieces",
        format!(
            "{}, the largest with {:.2} % of the particles; {} on one bond, {} on none",
            pieces.count,
            100.0 * pieces.largest_share,
            pieces.with_one_bond,
            pieces.without_bond
        ),
    ));
    // Near a wall the layers show, which is no preferred direction of the material.
    match (&report.interior_fabric, &report.fabric) {
        (Some(interior), _) => lines.push(("fabric inside", fabric(interior))),
        (None, Some(all)) => lines.push((
            "fabric",
            format!("{}; layers along the wall show", fabric(all)),
        )),
        (None, None) => {}
    }
    if let Some(thinnest) = &report.thinnest {
        let about = if thinnest.at_least {
            "at least"
        } else {
            "about"
        };
        lines.push((
            "thinnest part",
            format!(
                "{about} {} particles across ({})",
                significant(thinnest.particles_across, 2),
                show_length(thinnest.thickness_m)
            ),
        ));
    }
    let width = lines.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let mut text: String = lines
        .iter()
        .map(|(name, what)| format!("{name:width$}  {what}\n"))
        .collect();
    for warning in &report.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text
}

fn share(share: &Share) -> String {
    format!("{:.4} +- {:.4}", share.value, share.error)
}

fn value(share: Option<&Share>) -> String {
    share.map_or_else(|| "-".to_owned(), |s| format!("{:.3}", s.value))
}

fn fit(fit: &Fit) -> String {
    let verdict = if fit.passes() { "within" } else { "outside" };
    format!(
        "off by {:.4}, {verdict} chance ({:.4})",
        fit.distance, fit.limit_95
    )
}

fn fabric(fabric: &Fabric) -> String {
    let [a, b, c] = fabric.eigenvalues;
    format!(
        "{a:.4} {b:.4} {c:.4}, {:.1} sigma of {:.4} off 1/3; random directions are as far off in {} of cases",
        fabric.largest_deviation_in_sigma,
        fabric.sigma,
        percent(fabric.chance)
    )
}

fn of_a_radius(share: f64) -> String {
    if share > 0.0 {
        format!("{share:.1e} of a radius")
    } else {
        "none".to_owned()
    }
}

fn percent(chance: f64) -> String {
    if chance < 1e-4 {
        "< 0.01 %".to_owned()
    } else {
        format!("{} %", significant(100.0 * chance, 2))
    }
}
