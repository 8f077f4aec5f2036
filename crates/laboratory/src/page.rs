//! The page of a series of specimens: numbers, each curve with its regions, and the mean curve.

use std::ops::Range;

use dem_io::units::show_quantity;
use dem_plots::{Column, Line, MOST_LINES, Page, Plot, Row, Table};

use crate::evaluation::EvaluatedSpecimen;
use crate::failure_line::FailureLine;
use crate::material::MeasuredMaterial;
use crate::specimen::{Dimensions, Specimen, TestType};
use crate::statistic::Statistic;

/// Everything about a series on one page that needs no other file. `material`: of the valid
/// specimens, if there are any; `reference`: the specimen to which curves are scaled.
pub fn page(
    evaluated: &[EvaluatedSpecimen],
    material: Option<&MeasuredMaterial>,
    reference: &Specimen,
) -> String {
    let mut page = Page::new("measured curves");
    add_series(&mut page, evaluated, material, reference);
    page.html()
}

/// The specimens of one pressure.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Type of test.
    pub test: TestType,
    /// Dimensions to which they are scaled, with the pressure.
    pub dimensions: Dimensions,
    /// The specimen of these dimensions.
    pub reference: Specimen,
    /// The specimens.
    pub evaluated: Vec<EvaluatedSpecimen>,
    /// What the valid ones say. None: there are none.
    pub material: Option<MeasuredMaterial>,
}

impl Series {
    /// The pressure, Pa.
    pub fn pressure_pa(&self) -> f64 {
        self.dimensions.pressure_pa().unwrap_or(0.0)
    }

    /// What the pressure is called.
    pub fn name(&self) -> String {
        self.test.pressure().unwrap_or("pressure").replace('_', " ")
    }
}

/// Everything about series under several pressures on one page, with the line through their
/// strengths.
pub fn page_of_series(series: &[Series], line: Option<&FailureLine>) -> String {
    let mut page = Page::new("measured curves");
    if let Some(line) = line {
        page.paragraph(&line.note());
        page.figure(&strengths_plot(series, line).svg());
    }
    for one in series {
        page.heading(&format!(
            "{} {}",
            one.name(),
            show_quantity(one.pressure_pa(), "Pa")
        ));
        add_series(
            &mut page,
            &one.evaluated,
            one.material.as_ref(),
            &one.reference,
        );
    }
    page.html()
}

/// Strengths of the valid specimens over the pressure, and the line of Mohr and Coulomb.
fn strengths_plot(series: &[Series], line: &FailureLine) -> Plot {
    let test = series.first().map(|one| one.test);
    let mut means = Vec::new();
    let mut residuals = Vec::new();
    let mut fitted = Vec::new();
    for one in series {
        let Some(material) = &one.material else {
            continue;
        };
        let pressure_pa = one.pressure_pa();
        means.push([pressure_pa, material.strength_pa.mean]);
        residuals.extend(
            material
                .residual_pa
                .map(|stress| [pressure_pa, stress.mean]),
        );
        fitted.push([pressure_pa, line.strength_pa(test, pressure_pa)]);
    }
    let lines = vec![
        Line::new("strength", means),
        Line::new("residual strength", residuals),
        Line::dashed("Mohr and Coulomb", fitted),
    ];
    Plot::of(
        "Strength over pressure",
        "pressure (Pa)",
        "strength (Pa)",
        lines,
    )
}

/// Numbers, mean curve and specimens of a series.
fn add_series(
    page: &mut Page,
    evaluated: &[EvaluatedSpecimen],
    material: Option<&MeasuredMaterial>,
    reference: &Specimen,
) {
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
    if let Some(residual) = material.residual_pa {
        all.insert(1, ("residual strength", "Pa", residual));
    }
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
        let unit = Dimensions::unit_of(name).1;
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
