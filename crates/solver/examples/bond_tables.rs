//! Two tables and a plot of doc/studies.md, made by running their studies. From the folder of the
//! clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example bond_tables -- failure
//! cargo run --release -p dem-run --example bond_tables -- damping
//! ```
//!
//! Builds the program, runs `failure-models.toml` or `structural-damping.toml`, some minutes each,
//! and writes the table into the page; `failure` also writes `doc/failure-models.svg`, load over
//! travel. Results are in `target/bond-tables`; `--resume` at the end keeps the complete runs.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod programs;

use dem_io::units::significant;
use dem_plots::{Axis, Line, Plot};

use programs::study::{Run, Table, runs};
use programs::{Failed, results, root};

const PAGE: &str = "doc/studies.md";

/// What follows from 12.05 MPa and 0.21 MPa by eqs. 18 and 19 of Platzer 2022: load, N, and travel
/// at failure, m.
const OF_EQUATIONS: [f64; 2] = [51.45, 2.82e-3];

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let resume = words.get(1).is_some_and(|word| word == "--resume");
    let folder = results("bond-tables")?;
    match words.first().map(String::as_str) {
        Some("failure") => {
            let study = "failure-models";
            failure(&runs(study, &folder.join(study), resume)?)
        }
        Some("damping") => {
            let study = "structural-damping";
            damping(&runs(study, &folder.join(study), resume)?)
        }
        _ => Err("write failure or damping, then --resume or nothing".into()),
    }
}

/// Load and travel at the peak of a curve (travel from where the fitted line has no load, m; load,
/// N), the travel until half of the load is left, and the work until the end, J.
fn peak(curve: &[[f64; 2]]) -> ([f64; 2], f64, f64) {
    let highest = (curve.iter().enumerate()).max_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
    let (at, [travel_m, load_n]) = highest.map_or((0, [0.0; 2]), |(at, point)| (at, *point));
    let half = curve[at..].iter().find(|point| point[1] <= 0.5 * load_n);
    let work_j = curve
        .windows(2)
        .map(|two| 0.5 * (two[0][1] + two[1][1]) * (two[1][0] - two[0][0]))
        .sum();
    let further_m = half.map_or(f64::NAN, |point| point[0] - travel_m);
    ([load_n, travel_m], further_m, work_j)
}

/// Load, travel, energy and time of each failure model.
fn failure(runs: &[Run]) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "bonds",
        "largest load",
        "off the equations",
        "travel there",
        "off the equations",
        "further travel until half of it",
        "work until then",
        "damage and breakage take",
        "processor time",
    ]);
    let mut lines = Vec::new();
    for run in runs {
        let curve = run.columns("force-displacement.csv", ["displacement_m", "load_n"])?;
        let (found, further_m, work_j) = peak(&curve);
        let off = [0, 1].map(|k| format!("{:+.0} %", 100.0 * (found[k] / OF_EQUATIONS[k] - 1.0)));
        let broken_j = run.balance_j("bond_damage_j") + run.balance_j("bond_breakage_j");
        let [off_load, off_travel] = off;
        table.row(&[
            run.settings[0].clone(),
            format!("{:.1} N", found[0]),
            off_load,
            format!("{:.2} mm", 1e3 * found[1]),
            off_travel,
            format!("{:.3} mm", 1e3 * further_m),
            format!("{:.0} mJ", 1e3 * work_j),
            format!("{:.1} mJ", 1e3 * broken_j),
            format!("{} s", significant(run.time_s, 2)),
        ]);
        let every = curve.len() / 400 + 1;
        lines.push(Line {
            name: run.settings[0].clone(),
            points: (curve.iter().step_by(every))
                .map(|[travel_m, load_n]| [1e3 * travel_m, *load_n])
                .collect(),
            dashed: false,
        });
    }
    let plot = Plot {
        title: "one bending test with each failure model".to_owned(),
        x: Axis::of("travel (mm)"),
        y: Axis::of("load (N)"),
        lines,
        ..Plot::default()
    };
    std::fs::write(root().join("doc/failure-models.svg"), plot.svg().file())?;
    table.write(PAGE, "bond_tables failure")
}

/// Rebound of a sample over the damping of its bonds, with three contacts.
fn damping(runs: &[Run]) -> Result<(), Failed> {
    const IMPACT_M_S: f64 = 4.0;
    let mut table = Table::new(&[
        "damping",
        "rebound height, contact of the scene",
        "without losses",
        "without losses, 100 times as stiff",
        "step, us",
        "processor time",
    ]);
    for same in runs.chunk_by(|a, b| a.settings[0] == b.settings[0]) {
        let mut cells = vec![same[0].settings[0].clone()];
        for run in same {
            let speed_m_s = largest(run, "rebound_speed")?;
            cells.push(format!("{:.0} %", 100.0 * (speed_m_s / IMPACT_M_S).powi(2)));
        }
        let step_s = same[0].summary["time_step_s"].as_f64();
        cells.push(significant(1e6 * step_s.unwrap_or(f64::NAN), 3));
        cells.push(format!("{} s", significant(same[0].time_s, 2)));
        table.row(&cells);
    }
    table.write(PAGE, "bond_tables damping")
}

/// The value of a measure of a run.
fn largest(run: &Run, name: &str) -> Result<f64, Failed> {
    let value = run.summary["measures"][name]["value"].as_f64();
    value.ok_or_else(|| format!("{name} is missing").into())
}
