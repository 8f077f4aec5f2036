//! doc/laboratory.md: packings of a sample bent at four points, and of a disc and a bar.

use dem_laboratory::figure::Figure;
use dem_laboratory::test_result::TestResult;
use dem_run::rig::evaluate::EQ_18;

use crate::bench::{Bench, Failed, ONE_THREAD, Run, body, sets};
use crate::cells::{change, scattered, thousands};
use crate::table::{Table, write};

const PAGE: &str = "doc/laboratory.md";

/// The packings for a mean and its scatter.
pub(crate) const SEEDS: [u32; 4] = [1, 2, 3, 4];

pub(crate) const DISC_AND_BAR: [(&str, &str); 3] = [
    ("brazilian-disc", "disc"),
    ("compression", "bar"),
    ("tension", "bar"),
];

pub(crate) fn tables() -> [Table; 2] {
    let bending = "packing | bonds | E by eq. 18 | specimen modulus over bond modulus | \
        failure force | half the rate changes E, force | crack from the middle | \
        broken bonds between the pins";
    let disc_and_bar = "scene | bonds | failure force | strength | specimen modulus | \
        half the rate changes the force | crack from the middle";
    let seeds = SEEDS.map(|seed| format!("`--seed {seed}`"));
    let packings = seeds.into_iter().chain(["mean +- scatter".to_owned()]);
    let scenes = DISC_AND_BAR.map(|(scene, _)| format!("`{scene}.toml`"));
    [
        Table::new(PAGE, "laboratory bending", bending, packings),
        Table::new(PAGE, "laboratory disc-and-bar", disc_and_bar, scenes),
    ]
}

/// Settings of the four-point test of a packing: its rate is checked for the first one only, as
/// that takes half as long again.
pub(crate) fn bending_sets(seed: u32) -> &'static [&'static str] {
    match seed {
        1 => &[],
        _ => &["test.rate_check=false"],
    }
}

/// A test of a packing, and its results. `file`: the body of the scene, and its shape.
fn tested(
    bench: &Bench,
    scene: &str,
    file: (&str, &str),
    seed: u32,
    set: &[&str],
) -> Result<(Run, TestResult), Failed> {
    let (name, shape) = file;
    let file = bench.usual(shape, "2mm..3mm", seed)?;
    let mut options = sets(set);
    options.extend([ONE_THREAD.to_owned(), body(name, &file)]);
    let path = format!("data/scenes/{scene}.toml");
    let run = bench.run(&format!("{scene}-{seed}"), &path, &options)?;
    let test = run.test()?;
    Ok((run, test))
}

/// A row for each packing.
pub(crate) fn bending(bench: &Bench) -> Result<(), Failed> {
    let [mut table, _] = tables();
    let (mut moduli, mut ratios, mut forces) = (Vec::new(), Vec::new(), Vec::new());
    for seed in SEEDS {
        let sample = ("sample", "bending-sample");
        let set = bending_sets(seed);
        let (run, test) = tested(bench, "four-point-bending", sample, seed, set)?;
        table.row(bending_cells(&run, &test));
        moduli.push(1e-6 * value(&test.figures, EQ_18));
        ratios.push(value(&test.calibration, RATIO));
        forces.push(value(&test.figures, FAILURE_FORCE));
    }
    table.row([
        String::new(),
        scattered(&moduli, 2, "MPa"),
        scattered(&ratios, 2, ""),
        scattered(&forces, 1, "N"),
        String::new(),
        String::new(),
        String::new(),
    ]);
    write(&[table])
}

const FAILURE_FORCE: &str = "failure force";
const RATIO: &str = "specimen modulus over bond modulus";

fn value(figures: &[Figure], name: &str) -> f64 {
    let found = figures.iter().find(|figure| figure.name == name);
    found.map_or(f64::NAN, |figure| figure.value)
}

fn bending_cells(run: &Run, test: &TestResult) -> Vec<String> {
    let changes = [EQ_18, FAILURE_FORCE].map(|name| value(&test.half_the_rate_changes, name));
    let there = changes.into_iter().filter(|value| value.is_finite());
    let changes: Vec<String> = there.map(|value| change(value, 1)).collect();
    let with_error = |name: &str, factor: f64, digits: usize, unit: &str| {
        let found = test.figures.iter().find(|figure| figure.name == name);
        found.map_or_else(String::new, |figure| {
            let error = change(figure.error.unwrap_or(f64::NAN), 1);
            format!("{:.digits$} {unit} ({error})", factor * figure.value)
        })
    };
    let crack = test.crack.as_ref();
    vec![
        thousands(run.summary.bonds as f64),
        with_error(EQ_18, 1e-6, 2, "MPa"),
        format!("{:.2}", value(&test.calibration, RATIO)),
        with_error(FAILURE_FORCE, 1.0, 1, "N"),
        changes.join(", "),
        crack.map_or_else(String::new, |crack| {
            let [offset_mm, spread_mm] = [crack.offset_m, crack.spread_m].map(|m| 1e3 * m);
            format!("{offset_mm:.1} mm +- {spread_mm:.1} mm")
        }),
        crack.map_or_else(String::new, |crack| {
            format!("{:.0} %", 100.0 * crack.fraction_within)
        }),
    ]
}

/// A row for each scene, over all packings.
pub(crate) fn disc_and_bar(bench: &Bench) -> Result<(), Failed> {
    let [_, mut table] = tables();
    for (scene, shape) in DISC_AND_BAR {
        let tests = SEEDS.map(|seed| tested(bench, scene, (shape, shape), seed, &[]));
        let tests: Vec<(Run, TestResult)> = tests.into_iter().collect::<Result<_, _>>()?;
        let over = |of: &dyn Fn(&(Run, TestResult)) -> f64, digits, unit: &str| {
            scattered(&tests.iter().map(of).collect::<Vec<_>>(), digits, unit)
        };
        let figure = |name, factor: f64, digits, unit: &str| {
            over(
                &|(_, test)| factor * value(&test.figures, name),
                digits,
                unit,
            )
        };
        let crack_mm = |test: &TestResult| test.crack.as_ref().map(|crack| 1e3 * crack.offset_m);
        let changes = |test: &TestResult| value(&test.half_the_rate_changes, FAILURE_FORCE);
        table.row([
            over(&|(run, _)| run.summary.bonds as f64, 0, ""),
            figure(FAILURE_FORCE, 1.0, 1, "N"),
            figure("strength", 1e-6, 4, "MPa"),
            figure("specimen modulus", 1e-6, 2, "MPa"),
            over(&|(_, test)| 100.0 * changes(test), 1, "%"),
            over(&|(_, test)| crack_mm(test).unwrap_or(f64::NAN), 1, "mm"),
        ]);
    }
    write(&[table])
}
