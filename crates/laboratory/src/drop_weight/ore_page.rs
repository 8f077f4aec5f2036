//! The page of an ore: numbers, t10 over energy, master curve, family, broken specimens.

use dem_io::units::significant;
use dem_physics::breakage::BreakageLaw;
use dem_plots::{Axis, Column, Line, Marks, Page, Plot, Point, Table};

use super::ore::{FittedOre, SizeResidual};
use super::ore_text::{ore_numbers, shown_mm};
use super::refused::{kwh_t, percent};
use super::sheet::{DropWeightSheets, DropWeightTest};
use super::size::{SizeGroup, size_groups};
use crate::units::J_KG_OF_KWH_T;

/// Points of a curve.
const POINTS: u32 = 150;
/// Energies of curves go up to the largest of the tests times this.
const BEYOND: f64 = 1.05;

/// Everything about an ore on one page that needs no other file.
pub fn ore_page(ore: &FittedOre, sheets: &DropWeightSheets, material: &str) -> String {
    let mut page = Page::new("drop-weight tests");
    let of = if sheets.ore.is_empty() {
        String::new()
    } else {
        format!(" of {}", sheets.ore)
    };
    page.paragraph(&format!(
        "Material {material}: {} tests{of} from {}; b and the fracture energy are those of a size of {}.",
        sheets.tests.len(),
        sheets.files.join(", "),
        shown_mm(ore.law.reference_size_m)
    ));
    page.table(&Table {
        columns: vec![
            Column::text(""),
            Column::number("value"),
            Column::number("95 % confidence interval"),
        ],
        rows: (ore_numbers(ore).into_iter())
            .map(|one| vec![one.name.to_owned(), one.value, one.interval].into())
            .collect(),
    });
    page.small("A and b depend strongly on each other: their product is known better than either.");
    page.list(&[ore.doubts.clone(), sheets.notes.clone()].concat());
    for plot in ore_plots(ore, sheets) {
        page.figure(&plot.svg());
    }
    page.heading("Residuals");
    page.table(&residuals(ore));
    if !ore.family.is_empty() {
        page.heading("Family");
        page.table(&family(ore));
    }
    page.html()
}

fn residuals(ore: &FittedOre) -> Table {
    let points = |share: f64| format!("{:.1} points", 100.0 * share);
    let law = &ore.law;
    let product = |size_m: f64| {
        let at_size = (size_m / law.reference_size_m).powf(law.b_exponent);
        let product = 100.0 * J_KG_OF_KWH_T * law.largest_t10 * law.b_kg_j * at_size;
        format!("{} t/kWh", significant(product, 3))
    };
    let all = [
        "all".to_owned(),
        ore.tests.to_string(),
        String::new(),
        points(ore.rms),
        String::new(),
    ];
    let row = |one: &SizeResidual| {
        let size = shown_mm(one.size_m);
        let [mean, rms] = [one.mean, one.rms].map(points);
        vec![size, one.tests.to_string(), mean, rms, product(one.size_m)].into()
    };
    Table {
        columns: vec![
            Column::text("size"),
            Column::number("tests"),
            Column::number("measured t10 less fitted, mean"),
            Column::number("root mean square"),
            Column::number("A x b, A in %"),
        ],
        rows: ore
            .by_size
            .iter()
            .map(row)
            .chain([all.to_vec().into()])
            .collect(),
    }
}

fn family(ore: &FittedOre) -> Table {
    Table {
        columns: vec![
            Column::text(""),
            Column::number("tests"),
            Column::number("off the family, root mean square"),
        ],
        rows: (ore.family.iter())
            .map(|one| {
                let name = format!("t{}", one.n);
                vec![
                    name,
                    one.tests.to_string(),
                    format!("{} points", percent(one.rms)),
                ]
                .into()
            })
            .collect(),
    }
}

/// The plots of an ore.
pub fn ore_plots(ore: &FittedOre, sheets: &DropWeightSheets) -> Vec<Plot> {
    let (law, tests) = (&ore.law, &sheets.tests[..]);
    let has_t10 = |group: &SizeGroup| group.tests.iter().any(|at| tests[*at].t10.is_some());
    let has_broken = |group: &SizeGroup| group.tests.iter().any(|at| tests[*at].broken.is_some());
    let [of_t10, of_broken] = [&has_t10 as &dyn Fn(&SizeGroup) -> bool, &has_broken].map(|has| {
        let mut groups = size_groups(tests);
        groups.retain(has);
        groups
    });
    let mut plots = vec![
        t10_plot(law, tests, &of_t10),
        master_plot(law, tests, &of_t10),
    ];
    if !ore.family.is_empty() {
        plots.push(family_plot(ore, tests));
    }
    if !of_broken.is_empty() {
        plots.push(broken_plot(law, tests, &of_broken));
    }
    plots
}

/// A curve over energies, kWh/t, up to the largest of these tests.
fn curve(name: String, most_j_kg: f64, value: impl Fn(f64) -> f64) -> Line {
    let point = |at: u32| {
        let energy_j_kg = BEYOND * most_j_kg * f64::from(at) / f64::from(POINTS);
        [energy_j_kg / J_KG_OF_KWH_T, value(energy_j_kg)]
    };
    Line::new(name, (0..=POINTS).map(point).collect())
}

/// Marks of one kind; each has its place as a tooltip.
fn marks(points: impl Iterator<Item = ([f64; 2], String)>) -> Marks {
    let mark = |(at, title)| Point {
        at,
        title,
        filled: true,
        ..Point::default()
    };
    Marks {
        points: points.map(mark).collect(),
        ..Marks::default()
    }
}

fn largest_energy_j_kg(tests: &[DropWeightTest], group: &SizeGroup) -> f64 {
    let energies = group.tests.iter().map(|at| tests[*at].energy_j_kg);
    energies.fold(0.0, f64::max)
}

fn t10_plot(law: &BreakageLaw, tests: &[DropWeightTest], groups: &[SizeGroup]) -> Plot {
    let line = |group: &SizeGroup| {
        let most_j_kg = largest_energy_j_kg(tests, group);
        curve(shown_mm(group.size_m), most_j_kg, |energy| {
            100.0 * law.mean_t10(group.size_m, energy)
        })
    };
    let points = |group: &SizeGroup| {
        marks(group.tests.iter().filter_map(|at| {
            let test = &tests[*at];
            Some((
                [test.energy_j_kg / J_KG_OF_KWH_T, 100.0 * test.t10?],
                test.place.clone(),
            ))
        }))
    };
    Plot {
        marks: groups.iter().map(points).collect(),
        ..Plot::of(
            "t10 over energy",
            "energy (kWh/t)",
            "t10 (%)",
            groups.iter().map(line).collect(),
        )
    }
}

/// All sizes on the curve of the reference size.
fn master_plot(law: &BreakageLaw, tests: &[DropWeightTest], groups: &[SizeGroup]) -> Plot {
    let mut most_j_kg: f64 = 0.0;
    let mut kinds = Vec::new();
    for group in groups {
        let mut points = Vec::new();
        for at in &group.tests {
            let test = &tests[*at];
            if let Some(t10) = test.t10 {
                let energy_j_kg = energy_at_reference_j_kg(law, test);
                most_j_kg = most_j_kg.max(energy_j_kg);
                points.push((
                    [energy_j_kg / J_KG_OF_KWH_T, 100.0 * t10],
                    test.place.clone(),
                ));
            }
        }
        kinds.push(Marks {
            name: shown_mm(group.size_m),
            ..marks(points.into_iter())
        });
    }
    let law_at_reference = |energy| 100.0 * law.mean_t10(law.reference_size_m, energy);
    let line = Line {
        dashed: true,
        ..curve("law".to_owned(), most_j_kg, law_at_reference)
    };
    Plot {
        marks: kinds,
        ..Plot::of(
            "Master curve",
            &format!(
                "energy with the same effect at {} (kWh/t)",
                shown_mm(law.reference_size_m)
            ),
            "t10 (%)",
            vec![line],
        )
    }
}

/// The energy, J/kg, that by the law gives particles of the reference size the same t10.
fn energy_at_reference_j_kg(law: &BreakageLaw, test: &DropWeightTest) -> f64 {
    let scaled_j_kg = test.energy_j_kg * (test.size_m / law.reference_size_m).powf(law.b_exponent);
    if law.energy_exponent == law.b_exponent {
        return scaled_j_kg;
    }
    let t10 = law.mean_t10(test.size_m, test.energy_j_kg);
    let (mut low, mut high) = (0.0, 2.0 * scaled_j_kg + law.fracture_energy_j_kg);
    for _ in 0..50 {
        let middle = f64::midpoint(low, high);
        if law.mean_t10(law.reference_size_m, middle) < t10 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

fn family_plot(ore: &FittedOre, tests: &[DropWeightTest]) -> Plot {
    let most = tests.iter().filter_map(|test| test.t10).fold(0.0, f64::max);
    let line = |n: f64| {
        let point = |at: u32| {
            let t10 = (BEYOND * most).min(1.0) * f64::from(at) / f64::from(POINTS);
            [100.0 * t10, 100.0 * ore.law.passing(n, t10)]
        };
        Line::new(format!("t{n}"), (0..=POINTS).map(point).collect())
    };
    let points = |n: f64| {
        marks(tests.iter().filter_map(move |test| {
            let share = test.family.iter().find(|[other, _]| *other == n)?[1];
            Some(([100.0 * test.t10?, 100.0 * share], test.place.clone()))
        }))
    };
    let lines = ore.family.iter().map(|one| line(one.n)).collect();
    Plot {
        marks: ore.family.iter().map(|one| points(one.n)).collect(),
        ..Plot::of("Family", "t10 (%)", "passing (%)", lines)
    }
}

fn broken_plot(law: &BreakageLaw, tests: &[DropWeightTest], groups: &[SizeGroup]) -> Plot {
    // From half the least energy of the tests to twice the largest, in equal factors.
    let line = |group: &SizeGroup| {
        let energies = group.tests.iter().filter(|at| tests[**at].broken.is_some());
        let energies = energies.map(|at| tests[*at].energy_j_kg);
        let [least, most] = energies.fold([f64::INFINITY, 0.0], |[least, most], energy| {
            [energy.min(least), energy.max(most)]
        });
        let point = |at: u32| {
            let part = f64::from(at) / f64::from(POINTS);
            let energy_j_kg = 0.5 * least * (4.0 * most / least).powf(part);
            let share = law.broken_share(group.size_m, energy_j_kg);
            [energy_j_kg / J_KG_OF_KWH_T, 100.0 * share]
        };
        let points = (0..=POINTS).map(point).collect();
        Line::new(shown_mm(group.size_m), points)
    };
    let points = |group: &SizeGroup| {
        marks(group.tests.iter().filter_map(|at| {
            let test = &tests[*at];
            let [count, broken] = test.broken?;
            let title = format!(
                "{}: {broken} of {count} at {} kWh/t",
                test.place,
                kwh_t(test.energy_j_kg)
            );
            Some((
                [test.energy_j_kg / J_KG_OF_KWH_T, 100.0 * broken / count],
                title,
            ))
        }))
    };
    let lines = groups.iter().map(line).collect();
    Plot {
        marks: groups.iter().map(points).collect(),
        x: Axis::log("energy (kWh/t)"),
        ..Plot::of("Broken specimens", "", "broken (%)", lines)
    }
}
