//! The content of the page: results of the five cases as tables and plots.

use dem_plots::{Axis, Line, Plot};
use dem_run::physics::bond::stiffness::BondModel;

use super::bar::{Bar, euler_bernoulli_m, timoshenko_m};
use super::cases::{
    COUNTS, KAPPA_OF_CASE_5, Small, TOLERANCE, case1, case2, case3, case4, case5, small,
};
use super::models::{MODELS, PARALLEL};
use crate::verification::table::{digits, head, row};

/// Names of the lines of plots; models without a name are not drawn. The elastic solid bond has the
/// stiffnesses of the parallel bond if spheres are equal.
const DRAWN: [&str; 5] = [
    "parallel, elastic solid",
    "Euler-Bernoulli",
    "Timoshenko",
    "",
    "shear coefficient",
];

/// The same if the shear coefficient hardly matters: within 0.06 %.
const DRAWN_TOGETHER: [&str; 5] = [
    "parallel, elastic solid, shear coefficient",
    "Euler-Bernoulli",
    "Timoshenko",
    "",
    "",
];

/// A deflection in mm.
pub(crate) fn mm(deflection_m: f64, decimals: usize) -> String {
    digits(
        1e3 * deflection_m,
        decimals,
        2.0 * TOLERANCE * 1e3 * deflection_m,
    )
}

/// Deviation of a deflection from a theory, per cent.
pub(crate) fn off(deflection_m: f64, theory_m: f64) -> String {
    digits(
        100.0 * (deflection_m / theory_m - 1.0),
        2,
        200.0 * TOLERANCE,
    )
}

/// A value for a plot, without the digits that differ from machine to machine.
fn steady(value: f64, unit: f64) -> f64 {
    (value / unit).round() * unit + 0.0
}

fn axis(label: &str) -> Axis {
    Axis {
        label: label.to_owned(),
        ..Axis::default()
    }
}

fn line(name: &str, points: Vec<[f64; 2]>, dashed: bool) -> Line {
    Line {
        name: name.to_owned(),
        points,
        dashed,
    }
}

/// One line for each model that has a name, through its results at these positions along the axis.
fn lines(names: [&str; 5], places: &[f64], of: impl Fn(usize, usize) -> f64) -> Vec<Line> {
    (0..MODELS.len())
        .filter(|&m| !names[m].is_empty())
        .map(|m| {
            let points = places.iter().enumerate().map(|(i, &x)| [x, of(m, i)]);
            line(names[m], points.collect(), false)
        })
        .collect()
}

/// The same as dots.
fn dots(mut lines: Vec<Line>) -> Vec<Line> {
    for line in &mut lines {
        let gap = [f64::NAN; 2];
        line.points = line.points.iter().flat_map(|&at| [at, gap]).collect();
    }
    lines
}

/// Deviation from a theory for a plot, per cent.
fn per_cent(deflection_m: f64, theory_m: f64) -> f64 {
    steady(100.0 * (deflection_m / theory_m - 1.0), 1e-4)
}

/// Table 4 of the paper, and the bar's shape.
pub(crate) fn of_case1() -> (String, [Plot; 2]) {
    let found: Vec<Small> = MODELS
        .iter()
        .map(|named| small(&case1(named.model), TOLERANCE))
        .collect();
    let theory = case1(PARALLEL).timoshenko_m();
    let slender = euler_bernoulli_m(4.0, 4.0, 0.2);
    let mut table = head(&[
        "",
        "paper, mm",
        "here, mm",
        "exact, mm",
        "paper: off Timoshenko, %",
        "here: off Timoshenko, %",
    ]);
    let none = || String::new();
    table += &row(&[
        "Timoshenko's theory".to_owned(),
        "8.534".to_owned(),
        none(),
        mm(theory, 5),
        none(),
        none(),
    ]);
    table += &row(&[
        "Euler and Bernoulli's theory".to_owned(),
        "8.488".to_owned(),
        none(),
        mm(slender, 5),
        "0.54".to_owned(),
        off(slender, theory),
    ]);
    let printed = [
        ["8.508", "0.30"],
        ["8.489", "0.53"],
        ["8.537", "0.04"],
        ["", ""],
        ["", ""],
    ];
    for ((named, found), [tip, error]) in MODELS.iter().zip(&found).zip(printed) {
        let (exact, _) = case1(named.model).exact(super::bar::LOAD);
        table += &row(&[
            named.name.to_owned(),
            tip.to_owned(),
            mm(found.tip_m(), 5),
            mm(exact[10], 5),
            error.to_owned(),
            off(found.tip_m(), theory),
        ]);
    }

    let places: Vec<f64> = (0..=10).map(|i| 0.4 * f64::from(i)).collect();
    let spheres = |i: usize| steady(found[2].deflections_m[i], 1e-9);
    let spheres = places.iter().enumerate().map(|(i, &x)| [x, spheres(i)]);
    let mut shape = dots(vec![line("Timoshenko bonds", spheres.collect(), false)]);
    let fine = (0..=80).map(|i| 0.05 * f64::from(i));
    let curve = fine.map(|x| [x, steady(timoshenko_m(x, 4.0, 0.2), 1e-9)]);
    shape.push(line("Timoshenko's theory", curve.collect(), true));
    let beyond = &places[1..];
    let errors = lines(DRAWN, beyond, |m, i| {
        let theory = timoshenko_m(beyond[i], 4.0, 0.2);
        per_cent(found[m].deflections_m[i + 1], theory)
    });
    let plots = [
        Plot {
            title: "Case 1: deflection along the bar".to_owned(),
            x: axis("distance from the support (m)"),
            y: axis("deflection (m)"),
            lines: shape,
            ..Plot::default()
        },
        Plot {
            title: "Case 1: deflection along the bar, off theory".to_owned(),
            x: axis("distance from the support (m)"),
            y: axis("off Timoshenko's theory (%)"),
            lines: errors,
            ..Plot::default()
        },
    ];
    (table, plots)
}

/// Tips of bars with these numbers of bonds: a table of the deviations from Timoshenko's theory,
/// per cent, and for each bar its tips and the theory.
fn swept(
    counts: &[usize],
    bar: fn(usize, BondModel) -> Bar,
    first: impl Fn(usize) -> String,
) -> (String, Vec<([f64; 5], f64)>) {
    let mut table = String::new();
    let mut tips = Vec::new();
    for &bonds in counts {
        let found = MODELS.map(|named| small(&bar(bonds, named.model), TOLERANCE).tip_m());
        let theory = bar(bonds, PARALLEL).timoshenko_m();
        let mut cells = vec![first(bonds), mm(theory, 5)];
        cells.extend(found.map(|tip| off(tip, theory)));
        table += &row(&cells);
        tips.push((found, theory));
    }
    (table, tips)
}

/// Headers of the tables of cases 2 to 4.
fn swept_head(first: &str) -> String {
    let mut cells = vec![first, "theory, mm"];
    cells.extend(MODELS.iter().map(|named| named.name));
    head(&cells)
}

/// Shorter and shorter bars.
pub(crate) fn of_case2() -> (String, Plot) {
    let (rows, tips) = swept(&COUNTS, case2, |bonds| bonds.to_string());
    let places = COUNTS.map(|bonds| bonds as f64);
    let tip = |m: usize, i: usize| per_cent(tips[i].0[m], tips[i].1);
    let mut drawn = dots(lines(DRAWN, &places, tip));
    let fine = (10..=100).map(|i| 0.1 * f64::from(i));
    let theory = fine.map(|bonds| {
        let length = 0.4 * bonds;
        let slender = euler_bernoulli_m(length, length, 0.2);
        [bonds, per_cent(slender, timoshenko_m(length, length, 0.2))]
    });
    drawn.push(line("Euler and Bernoulli's theory", theory.collect(), true));
    let plot = Plot {
        title: "Case 2: slender and deep bars".to_owned(),
        x: axis("length over diameter"),
        y: axis("tip off Timoshenko's theory (%)"),
        lines: drawn,
        ..Plot::default()
    };
    (swept_head("bonds = length over diameter") + &rows, plot)
}

/// The same bar in fewer and longer bonds.
pub(crate) fn of_case3() -> (String, Plot) {
    let counts: Vec<usize> = (1..=10).collect();
    let (rows, tips) = swept(&counts, case3, |bonds| bonds.to_string());
    let places: Vec<f64> = counts.iter().map(|&bonds| bonds as f64).collect();
    let plot = Plot {
        title: "Case 3: the same bar in 1 to 10 bonds".to_owned(),
        x: axis("bonds"),
        y: axis("deflection of the tip (m)"),
        lines: lines(DRAWN_TOGETHER, &places, |m, i| steady(tips[i].0[m], 1e-9)),
        reference: Some((steady(tips[0].1, 1e-9), "Timoshenko's theory".to_owned())),
        ..Plot::default()
    };
    (swept_head("bonds") + &rows, plot)
}

/// Fewer and larger spheres in contact.
pub(crate) fn of_case4() -> (String, Plot) {
    let (rows, tips) = swept(&COUNTS, case4, |bonds| bonds.to_string());
    let places = COUNTS.map(|bonds| bonds as f64);
    let plot = Plot {
        title: "Case 4: fewer and larger spheres in contact".to_owned(),
        x: axis("bonds"),
        y: axis("tip off Timoshenko's theory (%)"),
        lines: lines(DRAWN_TOGETHER, &places, |m, i| {
            per_cent(tips[i].0[m], tips[i].1)
        }),
        ..Plot::default()
    };
    (swept_head("bonds") + &rows, plot)
}

/// A larger sphere between two.
pub(crate) fn of_case5() -> (String, Plot) {
    let middles = [0.2, 0.4, 0.8];
    let dispersion = [0.0, 0.75, 1.5];
    let adjusted = BondModel::Parallel {
        kappa: Some(KAPPA_OF_CASE_5),
    };
    let mut all: Vec<(&str, &str, BondModel)> = MODELS
        .iter()
        .map(|named| (named.name, named.name, named.model))
        .collect();
    // Drawn together: within 0.06 %.
    all[3].1 = "";
    all[4].1 = "elastic solid, shear coefficient";
    let name = "parallel, shear stiffness of EBBM";
    all.push((name, name, adjusted));
    let theory = case5(0.2, PARALLEL).timoshenko_m();
    let mut table = head(&["dispersion factor", "0", "0.75", "1.5"]);
    let mut drawn = Vec::new();
    for (name, of_line, model) in all {
        let tips = middles.map(|middle| small(&case5(middle, model), TOLERANCE).tip_m());
        let mut cells = vec![name.to_owned()];
        cells.extend(tips.map(|tip| off(tip, theory)));
        table += &row(&cells);
        let points = dispersion.iter().zip(tips);
        let points = points.map(|(&x, tip)| [x, per_cent(tip, theory)]);
        if !of_line.is_empty() {
            drawn.push(line(of_line, points.collect(), false));
        }
    }
    let plot = Plot {
        title: "Case 5: a larger sphere in the middle".to_owned(),
        x: axis("dispersion factor"),
        y: axis("tip off Timoshenko's theory (%)"),
        lines: drawn,
        ..Plot::default()
    };
    (table, plot)
}

/// Table 5 of the paper: stiffnesses of the bonds of case 3, next to the printed ones.
pub(crate) fn of_stiffnesses() -> String {
    let printed = [
        (1, ["6.283", "2.416", "0.04712", "0.04612"]),
        (2, ["12.56", "4.833", "0.3769", "0.3469"]),
        (4, ["25.13", "9.66", "3.016", "2.240"]),
        (6, ["37.69", "14.50", "10.18", "5.718"]),
        (8, ["50.26", "19.33", "24.13", "10.11"]),
        (10, ["62.83", "24.17", "47.12", "14.88"]),
    ];
    let mut table = head(&[
        "bonds",
        "axial, paper",
        "here",
        "shear PBM, paper",
        "here",
        "shear EBBM, paper",
        "here",
        "shear TBBM, paper",
        "here",
    ]);
    for (bonds, printed) in printed {
        let [parallel, slender, deep] =
            [0, 1, 2].map(|m| case3(bonds, MODELS[m].model).stiffness(0));
        let here = [parallel.normal, parallel.shear, slender.shear, deep.shear];
        let mut cells = vec![bonds.to_string()];
        for (printed, here) in printed.iter().zip(here) {
            let here = 1e-9 * here;
            let decimals = (4.0 - here.log10().floor()) as usize;
            cells.push((*printed).to_owned());
            cells.push(digits(here, decimals, 1e-12 * here));
        }
        table += &row(&cells);
    }
    table
}

/// Tips of case 1 under the full load of the paper, compared with small-deflection theory.
pub(crate) fn of_whole_load() -> String {
    let mut table = head(&[
        "",
        "small load, mm",
        "100 kN, total, mm",
        "100 kN, incremental, mm",
        "off, total, 1e-6",
        "off, incremental, 1e-6",
    ]);
    for named in MODELS {
        let mut bar = case1(named.model);
        let (exact, _) = bar.exact(super::bar::LOAD);
        let total = bar.at_rest(super::bar::LOAD).deflections_m[10];
        bar.incremental = true;
        let summed = bar.at_rest(super::bar::LOAD).deflections_m[10];
        let whole = |tip: f64| digits(1e3 * tip, 6, 1e-9 * 1e3 * tip);
        let less = |tip: f64| digits(1e6 * (tip / exact[10] - 1.0), 2, 2e-4);
        table += &row(&[
            named.name.to_owned(),
            whole(exact[10]),
            whole(total),
            whole(summed),
            less(total),
            less(summed),
        ]);
    }
    table
}
