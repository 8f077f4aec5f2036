//! The tables and plots of doc/dynamic-tests.md, made by running its scenes. From the folder of the
//! clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example dynamic_tables -- rates      # doc/strain-rate.svg
//! cargo run --release -p dem-run --example dynamic_tables -- heights    # doc/t10.svg
//! ```
//!
//! Builds both programs and runs the scenes unchanged except for the `--set`s printed on standard
//! error. The values are those of the studies `hopkinson-rates.toml` and
//! `drop-weight-heights.toml`.
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

use programs::{Failed, Programs, output, root};

const USAGE: &str = "write rates or heights";
/// As in the study.
const VELOCITIES: [&str; 6] = ["2 m/s", "3 m/s", "4 m/s", "6 m/s", "8 m/s", "10 m/s"];
const HEIGHTS: [&str; 7] = ["20 mm", "50 mm", "0.1 m", "0.2 m", "0.5 m", "1 m", "2 m"];
/// Scenes of the disc.
const DISC: &str = "hopkinson-disc";

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let work: fn(&Programs) -> Result<(), Failed> = match words.first().map(String::as_str) {
        Some("rates") => rates,
        Some("heights") => heights,
        _ => return Err(USAGE.into()),
    };
    work(&Programs::build()?)
}

/// The results of a scene with these settings.
fn results(programs: &Programs, scene: &str, sets: &[String]) -> Result<Value, Failed> {
    let mut command = Command::new(&programs.dem_run);
    command.arg(format!("data/scenes/{scene}.toml"));
    command.args(["--json", "--quiet", "--force", "--output"]);
    command.arg(programs::results("dynamic-tables")?.join(scene));
    for set in sets {
        command.args(["--set", set]);
    }
    Ok(serde_json::from_slice(&output(&mut command)?)?)
}

/// A figure of the test of a run.
fn figure(run: &Value, name: &str) -> f64 {
    let figures = run["test"]["results"].as_array();
    let found = figures
        .into_iter()
        .flatten()
        .find(|figure| figure["name"] == name);
    found
        .and_then(|figure| figure["value"].as_f64())
        .unwrap_or(f64::NAN)
}

fn row(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}

fn head(cells: &[&str]) {
    row(&cells
        .iter()
        .map(|cell| (*cell).to_owned())
        .collect::<Vec<_>>());
    println!("|{}", "---|".repeat(cells.len()));
}

fn line(name: &str, points: Vec<[f64; 2]>, dashed: bool) -> Line {
    Line {
        name: name.to_owned(),
        points,
        dashed,
    }
}

/// Strength of the same disc in the quasi-static test of brazilian-disc-rock.toml, Pa.
fn static_strength_pa(programs: &Programs) -> Result<f64, Failed> {
    let mut command = Command::new(&programs.dem_run);
    command.arg("data/scenes/brazilian-disc-rock.toml");
    command.args(["--json", "--quiet", "--force", "--output"]);
    command.arg(programs::results("dynamic-tables")?.join("brazilian-disc-rock"));
    command.args(["--body", "disc=data/bodies/disc.vtp"]);
    command.args([
        "--set",
        "test.rate_check=false",
        "--set",
        "test.periods=100",
    ]);
    let run: Value = serde_json::from_slice(&output(&mut command)?)?;
    Ok(figure(&run, "strength"))
}

/// Strength of the disc over the strain rate, without and with rate strengthening.
fn rates(programs: &Programs) -> Result<(), Failed> {
    let static_pa = static_strength_pa(programs)?;
    head(&[
        "striker, m/s",
        "strain rate, 1/s",
        "strength, MPa",
        "over static",
        "(F_1 - F_2)/F",
        "strain rate with eq. 20, 1/s",
        "strength, MPa",
        "over static",
        "eq. 20 at this rate",
    ]);
    let (mut without, mut with) = (Vec::new(), Vec::new());
    for velocity in VELOCITIES {
        let run = |strengthens: bool| {
            results(
                programs,
                DISC,
                &[
                    "test.striker.length=\"1.5 m\"".to_owned(),
                    format!("test.striker.velocity=\"{velocity}\""),
                    format!("bonds.rock.failure.rate_strengthening={strengthens}"),
                ],
            )
        };
        let [off, on] = [run(false)?, run(true)?];
        let of = |run: &Value| [figure(run, "strain rate"), figure(run, "strength")];
        let [[slow, weak], [fast, strong]] = [of(&off), of(&on)];
        without.push([slow, weak / static_pa]);
        with.push([fast, strong / static_pa]);
        let theory = dynamic_increase_factor(fast, 0.0);
        row(&[
            velocity.trim_end_matches(" m/s").to_owned(),
            significant(slow, 3),
            significant(1e-6 * weak, 3),
            significant(weak / static_pa, 3),
            significant(figure(&off, "force equilibrium"), 2),
            significant(fast, 3),
            significant(1e-6 * strong, 3),
            significant(strong / static_pa, 3),
            significant(theory, 3),
        ]);
    }
    println!(
        "\nStatic strength: {} MPa",
        significant(1e-6 * static_pa, 3)
    );
    let lowest = without
        .iter()
        .map(|[rate, _]| *rate)
        .fold(f64::INFINITY, f64::min);
    let rates = (0..=100).map(|i| {
        let share = f64::from(i) / 100.0;
        lowest * (HIGHEST_1_S / lowest).powf(share)
    });
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
            line("bonds with eq. 20", with, false),
            line("eq. 20", theory.collect(), true),
        ],
        ..Plot::default()
    };
    std::fs::write(root().join("doc/strain-rate.svg"), plot.svg().file())?;
    Ok(())
}

/// t10 and sizes over the specific energy.
fn heights(programs: &Programs) -> Result<(), Failed> {
    head(&[
        "height",
        "specific energy, kWh/t",
        "absorbed, kWh/t",
        "largest fragment",
        "d50, mm",
        "t10",
    ]);
    let mut points = Vec::new();
    for height in HEIGHTS {
        let sets = [
            format!("test.weight.height=\"{height}\""),
            "output.pictures=\"1 s\"".to_owned(),
        ];
        let run = results(programs, "drop-weight", &sets)?;
        let energy = figure(&run, "specific energy per tonne");
        let t10 = figure(&run, "t10");
        points.push([energy, 100.0 * t10]);
        row(&[
            height.to_owned(),
            significant(energy, 3),
            significant(figure(&run, "specific absorbed energy") / 3600.0, 3),
            format!(
                "{} %",
                significant(100.0 * figure(&run, "largest fragment"), 3)
            ),
            significant(1e3 * figure(&run, "d50"), 3),
            format!("{} %", significant(100.0 * t10, 3)),
        ]);
    }
    let plot = Plot {
        title: "fines over the energy of a drop weight".to_owned(),
        x: Axis::of("impact energy over mass of the disc (kWh/t)"),
        y: Axis::of("t10 (%)"),
        lines: vec![line("disc", points, false)],
        ..Plot::default()
    };
    std::fs::write(root().join("doc/t10.svg"), plot.svg().file())?;
    Ok(())
}
