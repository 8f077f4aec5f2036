//! The table of doc/replacement.md: the chute run in three ways, with several seeds. From the
//! folder of the clone:
//!
//! ```sh
//! cargo build --release && cargo run --release -p dem-run --example replacement_table
//! ```
//!
//! Takes a quarter of an hour. One thread and hardly any pictures, so that the steps are compared.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

use std::error::Error;
use std::path::Path;
use std::process::Command;

use dem_scene::study::Pieces;
use dem_study::masses::{by_chance, distance, masses_kg};

const WAYS: [(&str, &str); 3] = [
    ("chute-bonded", "breakable from the start"),
    ("chute", "clumps until they come to the plate"),
    ("chute-back", "quiet fragments restored"),
];
const SEEDS: usize = 4;

type Failed = Box<dyn Error>;

/// The recorded data of a run.
#[derive(Default)]
struct Run {
    wall_s: f64,
    energy_error: f64,
    left_out: f64,
    /// Masses of the fragments discharged, kg.
    masses_kg: Vec<f64>,
}

fn main() -> Result<(), Failed> {
    let own = std::env::current_exe()?;
    let release = own.parent().and_then(Path::parent).ok_or("no folder")?;
    let program = &release.join("dem-run");
    let folder = std::env::temp_dir().join("replacement-table");
    std::fs::create_dir_all(&folder)?;
    let mut runs: [Vec<Run>; 3] = Default::default();
    // In turn, so that a slowdown of the machine affects all equally.
    for seed in 0..SEEDS {
        for ((name, _), runs) in WAYS.iter().zip(&mut runs) {
            runs.push(run(
                program,
                name,
                seed,
                &folder.join(format!("{name}-{seed}")),
            )?);
            eprintln!("{name}, seed {seed}: {:.1} s", runs[seed].wall_s);
        }
    }
    println!(
        "| 2 s of the chute, one thread | time | faster | energy error | bond updates skipped | fragments discharged | mass that left |"
    );
    println!("|---|---|---|---|---|---|---|");
    let times = [0, 1, 2].map(|way| median(runs[way].iter().map(|run| run.wall_s)));
    for (way, (name, what)) in WAYS.iter().enumerate() {
        let all = &runs[way];
        let error = all
            .iter()
            .map(|run| run.energy_error.abs())
            .fold(0.0, f64::max);
        let left_out = median(all.iter().map(|run| run.left_out));
        let count = median(all.iter().map(|run| run.masses_kg.len() as f64));
        let mass_kg = median(all.iter().map(|run| run.masses_kg.iter().sum()));
        println!(
            "| `{name}.toml`: {what} | {:.1} s | {:.1} | {error:.1e} | {:.0} % | {count:.0} | {mass_kg:.3} kg |",
            times[way],
            times[0] / times[way],
            100.0 * left_out,
        );
    }
    println!("\n| distance of the masses (KS) | by number | by mass |\n|---|---|---|");
    for (way, (name, _)) in WAYS.iter().enumerate() {
        let of_seeds = pairs(&runs[way], &runs[way], |a, b| a < b);
        println!(
            "| two seeds of `{name}.toml` | {} | {} |",
            of_seeds[0], of_seeds[1]
        );
    }
    for (way, (name, _)) in WAYS.iter().enumerate().skip(1) {
        let between = pairs(&runs[way], &runs[0], |_, _| true);
        println!(
            "| `{name}.toml` and `{}.toml` | {} | {} |",
            WAYS[0].0, between[0], between[1]
        );
    }
    for (way, (name, _)) in WAYS.iter().enumerate().skip(1) {
        let [a, b] = [way, 0].map(|way| all_masses_kg(&runs[way]));
        let chance = by_chance(a.len(), b.len());
        let [number, mass] = [|_| 1.0, |kg| kg].map(|weight| distance(&a, &b, weight));
        println!(
            "| `{name}.toml`, all seeds together | {number:.3} (by chance, in one of twenty cases: {chance:.3}) | {mass:.2} |"
        );
    }
    Ok(())
}

fn run(program: &Path, name: &str, seed: usize, out: &Path) -> Result<Run, Failed> {
    let status = Command::new(program)
        .arg(format!("data/scenes/{name}.toml"))
        .args(["--threads", "1", "--quiet", "--force", "--output"])
        .arg(out)
        .args(["--set", "output.pictures=\"10 s\"", "--set"])
        .arg(format!("run.seed={seed}"))
        .output()?;
    if !status.status.success() {
        return Err(String::from_utf8_lossy(&status.stderr).into());
    }
    let summary: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.join("summary.json"))?)?;
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
    let masses_kg = masses_kg(Pieces::Left, out)?;
    Ok(Run {
        wall_s: number(&summary["wall_s"]),
        energy_error: number(&summary["energy_error"]),
        left_out: number(&summary["population"]["bond_updates_skipped"]),
        masses_kg,
    })
}

fn all_masses_kg(runs: &[Run]) -> Vec<f64> {
    runs.iter()
        .flat_map(|run| run.masses_kg.iter().copied())
        .collect()
}

/// Smallest to largest distance of pairs of runs, by number and by mass.
fn pairs(a: &[Run], b: &[Run], counts: impl Fn(usize, usize) -> bool) -> [String; 2] {
    [|_| 1.0, |kg| kg].map(|weight: fn(f64) -> f64| {
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for (i, a) in a.iter().enumerate() {
            for (_, b) in b.iter().enumerate().filter(|(j, _)| counts(i, *j)) {
                let apart = distance(&a.masses_kg, &b.masses_kg, weight);
                (least, most) = (least.min(apart), most.max(apart));
            }
        }
        format!("{least:.3} to {most:.3}")
    })
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 {
        values[half]
    } else {
        0.5 * (values[half - 1] + values[half])
    }
}
