//! The page of a series of specimens: numbers, each curve with its regions, and the mean curve.

use std::ops::Range;

use dem_io::units::show_quantity;
use dem_plots::{Column, Line, MOST_LINES, Page, Plot, Row, Table};

use crate::evaluation::EvaluatedSpecimen;
use crate::material::MeasuredMaterial;
use crate::specimen::{Dimensions, Specimen};
use crate::statistic::Statistic;

/// Everything about a series on one page that needs no other file. `material`: of the valid
/// specimens, if there are any; `reference`: the specimen to which curves are scaled.
pub fn page(
    evaluated: &[EvaluatedSpecimen],
    material: Option<&MeasuredMaterial>,
    reference: &Specimen,
) -> String {
    let mut page = Page::new("measured curves");
    if let Some(material) = material {
        page.paragraph(&format!(
            "{}, scaled to {}",
            material.test.name(),
            dimensions(&material.dimensions)
        ));
        page.table(&Table {
            columns: vec![
                Column::text(""),
                Column::number("mean"),
                Column::number("standard deviation"),
                Column::number("specimens"),
            ],
            rows: statistics(material)
                .into_iter()
                .map(|(name, unit, value)| row(name, unit, &value))
                .collect(),
        });
        page.figure(&mean_plot(evaluated, material, reference).svg());
    }
    page.heading("Specimens");
    page.table(&Table {
        columns: [
            "",
            "Young's modulus",
            "strength",
            "largest force",
            "travel at failure",
            "seating",
            "offset",
            "drift",
        ]
        .iter()
        .enumerate()
        .map(|(at, name)| {
            if at == 0 {
                Column::text(name)
            } else {
                Column::number(name)
            }
        })
        .collect(),
        rows: evaluated.iter().map(specimen_row).collect(),
    });
    for one in evaluated {
        let sentences: Vec<String> = one
            .doubts
            .iter()
            .map(|doubt| format!("left out: {doubt}"))
            .collect();
        page.figure(&regions_plot(one).svg());
        page.list(&[sentences, one.all_notes()].concat());
    }
    page.html()
}

/// Names, units and values of what a series says.
pub fn statistics(material: &MeasuredMaterial) -> Vec<(&'static str, &'static str, Statistic)> {
    let mut all = vec![
        ("strength", "Pa", material.strength_pa),
        ("failure force", "N", material.failure_force_n),
        (
            "crosshead travel at failure",
            "m",
            material.travel_at_failure_m,
        ),
        ("stiffness", "N/m", material.stiffness_n_m),
    ];
    if let Some(modulus) = material.young_modulus_pa {
        all.insert(0, ("Young's modulus", "Pa", modulus));
    }
    all
}

fn row(name: &str, unit: &str, value: &Statistic) -> Row {
    vec![
        name.to_owned(),
        show_quantity(value.mean, unit),
        show_quantity(value.standard_deviation, unit),
        value.count.to_string(),
    ]
    .into()
}

fn specimen_row(one: &EvaluatedSpecimen) -> Row {
    let regions = &one.regions;
    let curve = &one.measured.curve;
    let span_m = curve.travel_m[curve.travel_m.len() - 1] - curve.travel_m[0];
    Row {
        cells: vec![
            one.measured.name.clone(),
            one.young_modulus_pa
                .map_or_else(String::new, |modulus| show_quantity(modulus, "Pa")),
            show_quantity(one.strength_pa, "Pa"),
            show_quantity(regions.largest_n, "N"),
            show_quantity(one.travel_at_failure_m, "m"),
            show_quantity(regions.seating_m(curve), "m"),
            show_quantity(regions.offset_n, "N"),
            show_quantity(regions.drift_n_m * span_m, "N"),
        ],
        is_bad: !one.doubts.is_empty(),
        link: None,
    }
}

/// Dimensions in words: "support span 180 mm, width 30 mm".
fn dimensions(dimensions: &Dimensions) -> String {
    let one = |name: &&str| {
        let value = dimensions.get(name)?;
        let unit = if *name == "area" { "m2" } else { "m" };
        Some(format!(
            "{} {}",
            name.replace('_', " "),
            show_quantity(value, unit)
        ))
    };
    Dimensions::NAMES
        .iter()
        .filter_map(one)
        .collect::<Vec<String>>()
        .join(", ")
}

/// Force over displacement of a specimen, a colour for each region.
pub fn regions_plot(one: &EvaluatedSpecimen) -> Plot {
    let regions = &one.regions;
    let curve = &one.measured.curve;
    let rows = curve.travel_m.len();
    let points = |rows: Range<usize>| -> Vec<[f64; 2]> {
        rows.map(|row| {
            [
                curve.travel_m[row] - regions.start_m,
                regions.corrected_n[row],
            ]
        })
        .collect()
    };
    let linear = &regions.linear;
    // Each region begins where the one before ends.
    let parts = [
        ("before contact", 0..regions.contact + 1),
        ("seating", regions.contact..linear.start + 1),
        ("linear", linear.clone()),
        ("up to the largest force", linear.end - 1..regions.peak + 1),
        ("behind it", regions.peak..rows),
    ];
    let lines = parts.into_iter().filter(|(_, rows)| rows.len() > 1);
    let mut lines: Vec<Line> = lines
        .map(|(name, rows)| Line::new(name, points(rows)))
        .collect();
    lines.push(Line::dashed(
        "fitted line",
        vec![
            [0.0, 0.0],
            [regions.largest_n / regions.stiffness_n_m, regions.largest_n],
        ],
    ));
    Plot::of(
        one.measured.name.clone(),
        "displacement (m)",
        "load (N)",
        lines,
    )
}

/// The mean curve over those of the valid specimens, scaled.
fn mean_plot(
    evaluated: &[EvaluatedSpecimen],
    material: &MeasuredMaterial,
    reference: &Specimen,
) -> Plot {
    let valid = evaluated.iter().filter(|one| one.doubts.is_empty());
    let scaled = |one: &EvaluatedSpecimen| {
        let factor = one.measured.specimen.force_factor(reference);
        let rows = one.regions.contact..one.regions.peak + 1;
        let point = |row: usize| {
            let displacement_m = one.measured.curve.travel_m[row] - one.regions.start_m;
            [displacement_m, factor * one.regions.corrected_n[row]]
        };
        Line::new(one.measured.name.clone(), rows.map(point).collect())
    };
    // The colours of the plot are one for the mean and one for each specimen.
    let mut lines: Vec<Line> = valid.take(MOST_LINES - 1).map(scaled).collect();
    lines.push(Line::dashed(
        "mean",
        material
            .curve
            .iter()
            .map(|point| [point.displacement_m, point.load_n])
            .collect(),
    ));
    Plot::of("Mean curve", "displacement (m)", "load (N)", lines)
}
