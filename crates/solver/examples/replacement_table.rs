//! Writes the tables of doc/replacement.md, the first of them into README.md as well: the chute run
//! in three ways, with several seeds. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example replacement_table
//! ```
//!
//! Builds the program and takes a quarter of an hour. One thread and hardly any pictures, so that
//! the steps are compared. Results are in `target/replacement-table`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod programs;

use std::path::Path;

use dem_scene::study::Pieces;
use dem_study::masses::{by_chance, distance, masses_kg};

use programs::study::{Table, run_scene};
use programs::{Failed, Programs, results};

const PAGE: &str = "doc/replacement.md";
const WAYS: [(&str, &str); 3] = [
    ("chute-bonded", "breakable from the start"),
    ("chute", "clumps until they come to the plate"),
    ("chute-back", "quiet fragments restored"),
];
const SEEDS: usize = 4;

/// The recorded data of a run.
#[derive(Default)]
struct Run {
    processor_s: f64,
    energy_error: f64,
    left_out: f64,
    /// Masses of the fragments discharged, kg.
    masses_kg: Vec<f64>,
}

fn main() -> Result<(), Failed> {
    let program = Programs::build()?.dem_run;
    let folder = results("replacement-table")?;
    let mut runs: [Vec<Run>; 3] = Default::default();
    // In turn, so that a slowdown of the machine affects all equally.
    for seed in 0..SEEDS {
        for ((name, _), runs) in WAYS.iter().zip(&mut runs) {
            let out = folder.join(format!("{name}-{seed}"));
            runs.push(run(&program, name, seed, &out)?);
        }
    }
    for page in ["README.md", PAGE] {
        times(&runs).write(page, "replacement_table")?;
    }
    masses(&runs).write(PAGE, "replacement_table masses")
}

fn times(runs: &[Vec<Run>; 3]) -> Table {
    let mut table = Table::new(&[
        "2 s of the chute, one thread",
        "processor time",
        "faster",
        "energy error",
        "bond updates skipped",
        "fragments discharged",
        "mass discharged",
    ]);
    let times = [0, 1, 2].map(|way| median(runs[way].iter().map(|run| run.processor_s)));
    for (way, (name, what)) in WAYS.iter().enumerate() {
        let all = &runs[way];
        let errors = all.iter().map(|run| run.energy_error.abs());
        let masses = all.iter().map(|run| run.masses_kg.iter().sum());
        let skipped = median(all.iter().map(|run| run.left_out));
        table.row(&[
            format!("`{name}.toml`: {what}"),
            format!("{:.1} s", times[way]),
            format!("{:.1}", times[0] / times[way]),
            format!("{:.1e}", errors.fold(0.0, f64::max)),
            format!("{:.0} %", 100.0 * skipped),
            format!(
                "{:.0}",
                median(all.iter().map(|run| run.masses_kg.len() as f64))
            ),
            format!("{:.3} kg", median(masses)),
        ]);
    }
    table
}

fn masses(runs: &[Vec<Run>; 3]) -> Table {
    let mut table = Table::new(&["distance of the masses (KS)", "by number", "by mass"]);
    for (way, (name, _)) in WAYS.iter().enumerate() {
        let [number, mass] = pairs(&runs[way], &runs[way], |a, b| a < b);
        table.row(&[format!("two seeds of `{name}.toml`"), number, mass]);
    }
    for (way, (name, _)) in WAYS.iter().enumerate().skip(1) {
        let [number, mass] = pairs(&runs[way], &runs[0], |_, _| true);
        table.row(&[
            format!("`{name}.toml` and `{}.toml`", WAYS[0].0),
            number,
            mass,
        ]);
    }
    for (way, (name, _)) in WAYS.iter().enumerate().skip(1) {
        let [a, b] = [way, 0].map(|way| all_masses_kg(&runs[way]));
        let chance = by_chance(a.len(), b.len());
        let [number, mass] = [|_| 1.0, |kg| kg].map(|weight| distance(&a, &b, weight));
        table.row(&[
            format!("`{name}.toml`, all seeds together"),
            format!("{number:.3} (by chance, in one of twenty cases: {chance:.3})"),
            format!("{mass:.2}"),
        ]);
    }
    table
}

fn run(program: &Path, name: &str, seed: usize, out: &Path) -> Result<Run, Failed> {
    let seed = format!("run.seed={seed}");
    let options = ["--threads", "1", "--set", &seed].map(str::to_owned);
    let summary = run_scene(program, name, &options, out)?;
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or(f64::NAN);
    Ok(Run {
        processor_s: number(&summary["processor_s"]),
        energy_error: number(&summary["energy_error"]),
        left_out: number(&summary["population"]["bond_updates_skipped"]),
        masses_kg: masses_kg(Pieces::Left, out)?,
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
