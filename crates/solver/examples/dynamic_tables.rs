//! The tables of doc/dynamic-tests.md, made by running its studies. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example dynamic_tables -- rates
//! cargo run --release -p dem-run --example dynamic_tables -- heights
//! ```
//!
//! Builds the program and runs `hopkinson-rates.toml` or `drop-weight-heights.toml` as they are,
//! some minutes each. Results are written to `target/dynamic-tables`, with the plots
//! `strain-rate.svg`, strength over strain rate beside eq. 20, and `t10.svg`, fines over specific
//! energy; `--resume` at the end keeps the complete runs.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

#[allow(dead_code, reason = "other examples use the rest")]
mod programs;

use std::process::Command;

use dem_io::units::significant;
use dem_plots::{Axis, Line, Plot};
use dem_run::physics::bond::strain_rate::{HIGHEST_1_S, dynamic_increase_factor};
use serde_json::Value;

use programs::{Failed, Programs, output, results};

const USAGE: &str = "write rates or heights, then --resume or nothing";

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let resume = words.get(1).is_some_and(|word| word == "--resume");
    match words.first().map(String::as_str) {
        Some("rates") => rates(&runs("hopkinson-rates", resume)?),
        Some("heights") => heights(&runs("drop-weight-heights", resume)?),
        _ => Err(USAGE.into()),
    }
}

/// The summaries of the runs of a study, in its order.
fn runs(study: &str, resume: bool) -> Result<Vec<Value>, Failed> {
    let folder = results("dynamic-tables")?.join(study);
    let mut command = Command::new(Programs::build()?.dem_run);
    command.args(["sweep", &format!("data/studies/{study}.toml")]);
    command.args(["--json", "--quiet", "--output"]).arg(&folder);
    command.arg(if resume { "--resume" } else { "--force" });
    let table: Value = serde_json::from_slice(&output(&mut command)?)?;
    let runs = table["runs"].as_array().ok_or("the study has no runs")?;
    let summary = |run: &Value| -> Result<Value, Failed> {
        if let Some(why) = run["failed"].as_str() {
            return Err(why.into());
        }
        let number = run["number"].as_u64().unwrap_or_default();
        let file = folder.join(format!("runs/{number:04}-1/summary.json"));
        Ok(serde_json::from_slice(&std::fs::read(file)?)?)
    };
    runs.iter().map(summary).collect()
}

/// A figure of the test of a run; not a number if the run has none.
fn figure(run: &Value, name: &str) -> f64 {
    let figures = run["test"]["results"].as_array();
    let mut figures = figures.into_iter().flatten();
    let found = figures.find(|figure| figure["name"] == name);
    let value = found.and_then(|figure| figure["value"].as_f64());
    value.unwrap_or(f64::NAN)
}

fn row(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}

fn head(cells: &[&str]) {
    println!("| {} |", cells.join(" | "));
    println!("|{}", "---|".repeat(cells.len()));
}

fn line(name: &str, points: Vec<[f64; 2]>, dashed: bool) -> Line {
    Line {
        name: name.to_owned(),
        points,
        dashed,
    }
}

/// Strength of the disc over the strain rate, without rate strengthening and with it: the runs of
/// the study take turns.
fn rates(runs: &[Value]) -> Result<(), Failed> {
    head(&[
        "striker",
        "eq. 20 for bonds",
        "strain rate",
        "strength",
        "over the static one",
        "eq. 20 at this rate",
        "(F_1 - F_2)/F",
    ]);
    let mut curves = [Vec::new(), Vec::new()];
    for (at, run) in runs.iter().enumerate() {
        let strengthens = at % 2;
        let rate_1_s = figure(run, "strain rate");
        let factor = figure(run, "dynamic increase factor");
        curves[strengthens].push([rate_1_s, factor]);
        let theory = dynamic_increase_factor(rate_1_s, 0.0);
        row(&[
            format!(
                "{} m/s",
                significant(run["test"]["rate_m_s"].as_f64().unwrap_or(f64::NAN), 3)
            ),
            ["off", "on"][strengthens].to_owned(),
            format!("{} /s", significant(rate_1_s, 3)),
            format!("{} MPa", significant(1e-6 * figure(run, "strength"), 3)),
            significant(factor, 3),
            significant(theory, 3),
            format!("{:+.0} %", 100.0 * figure(run, "force equilibrium")),
        ]);
    }
    let [without, with] = curves;
    let all = without.iter().chain(&with).map(|[rate, _]| *rate);
    let lowest = all.fold(HIGHEST_1_S, f64::min);
    let highest = with.iter().map(|[rate, _]| *rate).fold(lowest, f64::max);
    let rates = (0..=50).map(|i| lowest * (highest / lowest).powf(f64::from(i) / 50.0));
    let theory = rates.map(|rate| [rate, dynamic_increase_factor(rate, 0.0)]);
    let plot = Plot {
        title: "strength of a disc over its strain rate".to_owned(),
        x: Axis {
            log: true,
            ..Axis::of("strain rate (1/s)")
        },
        y: Axis::of("strength over static strength"),
        lines: vec![
            line("without rate strengthening", without, false),
            line("eq. 20 for the bonds", with, false),
            line("eq. 20", theory.collect(), true),
        ],
        ..Plot::default()
    };
    std::fs::write(
        results("dynamic-tables")?.join("strain-rate.svg"),
        plot.svg().file(),
    )?;
    Ok(())
}

/// t10 and sizes over the specific energy.
fn heights(runs: &[Value]) -> Result<(), Failed> {
    head(&[
        "impact",
        "impact energy",
        "absorbed energy",
        "largest fragment",
        "d50",
        "t10",
    ]);
    let mut points = Vec::new();
    for run in runs {
        let energy = figure(run, "specific energy per tonne");
        let absorbed = figure(run, "specific absorbed energy") / 3600.0;
        let t10 = figure(run, "t10");
        points.push([energy, 100.0 * t10]);
        let percent = |share: f64| format!("{} %", significant(100.0 * share, 3));
        row(&[
            format!(
                "{} m/s",
                significant(run["test"]["rate_m_s"].as_f64().unwrap_or(f64::NAN), 3)
            ),
            format!("{} kWh/t", significant(energy, 3)),
            format!("{} kWh/t", significant(absorbed, 3)),
            percent(figure(run, "largest fragment")),
            format!("{} mm", significant(1e3 * figure(run, "d50"), 3)),
            percent(t10),
        ]);
    }
    let plot = Plot {
        title: "fines of a disc under a drop weight".to_owned(),
        x: Axis::of("impact energy over mass of the disc (kWh/t)"),
        y: Axis::of("t10 (%)"),
        lines: vec![line("", points, false)],
        ..Plot::default()
    };
    std::fs::write(
        results("dynamic-tables")?.join("t10.svg"),
        plot.svg().file(),
    )?;
    Ok(())
}
