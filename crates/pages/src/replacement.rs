//! doc/replacement.md, its first table in README.md as well: the chute run in three ways, with
//! several seeds.

use dem_scene::study::Pieces;
use dem_study::masses::{by_chance, distance, masses_kg};

use crate::bench::{Bench, Failed, ONE_THREAD, sets};
use crate::cells::{ends, median};
use crate::table::{Table, write};

const WAYS: [(&str, &str); 3] = [
    ("chute-bonded", "breakable from the start"),
    ("chute-region", "in a region around the plate"),
    ("chute", "from the first touch until no bond breaks"),
];
const SEEDS: usize = 8;

/// The recorded data of a run.
struct Run {
    processor_s: f64,
    energy_error: f64,
    left_out: f64,
    /// Masses of the fragments discharged, kg.
    masses_kg: Vec<f64>,
}

/// The table of times, for both pages, and that of the masses.
pub(crate) fn tables() -> [Table; 3] {
    const WORDS: &str = "replacement";
    let of_times = "2 s of the chute, one thread | processor time | faster | energy error | \
        bond updates skipped | fragments discharged | mass discharged";
    let of_masses = "distance of the masses (KS) | by number | by mass";
    let ways = WAYS.map(|(name, what)| format!("`{name}.toml`: {what}"));
    let [bonded, region, touch] = WAYS.map(|(name, _)| format!("`{name}.toml`"));
    let mut pairs = [&bonded, &region, &touch]
        .map(|way| format!("two seeds of {way}"))
        .to_vec();
    pairs.extend([&region, &touch].map(|way| format!("{way} and {bonded}")));
    pairs.extend([&region, &touch].map(|way| format!("{way}, all seeds together")));
    let page = "doc/replacement.md";
    [
        Table::new("README.md", WORDS, of_times, ways.clone()),
        Table::new(page, WORDS, of_times, ways),
        Table::new(page, WORDS, of_masses, pairs),
    ]
}

pub(crate) fn replacement(bench: &Bench) -> Result<(), Failed> {
    let mut runs: [Vec<Run>; 3] = Default::default();
    // In turn, so that a slowdown of the machine affects all equally.
    for seed in 0..SEEDS {
        for ((name, _), runs) in WAYS.iter().zip(&mut runs) {
            runs.push(run(bench, name, seed)?);
        }
    }
    let [mut first, mut second, mut of_masses] = tables();
    let bonded_s = median(runs[0].iter().map(|run| run.processor_s));
    for all in &runs {
        let cells = times(all, bonded_s);
        first.row(cells.clone());
        second.row(cells);
    }
    masses(&runs, &mut of_masses);
    write(&[first, second, of_masses])
}

/// The cells of a way, and the processor time of the first one, s.
fn times(all: &[Run], bonded_s: f64) -> [String; 6] {
    let time_s = median(all.iter().map(|run| run.processor_s));
    let errors = all.iter().map(|run| run.energy_error.abs());
    let counts = all.iter().map(|run| run.masses_kg.len() as f64);
    let masses = all.iter().map(|run| run.masses_kg.iter().sum());
    [
        format!("{time_s:.1} s"),
        format!("{:.1}", bonded_s / time_s),
        format!("{:.1e}", errors.fold(0.0, f64::max)),
        format!(
            "{:.0} %",
            100.0 * median(all.iter().map(|run| run.left_out))
        ),
        format!("{:.0}", median(counts)),
        format!("{:.3} kg", median(masses)),
    ]
}

fn masses(runs: &[Vec<Run>; 3], table: &mut Table) {
    for of_way in runs {
        table.row(pairs(of_way, of_way, |a, b| a < b));
    }
    for of_way in &runs[1..] {
        table.row(pairs(of_way, &runs[0], |_, _| true));
    }
    for of_way in &runs[1..] {
        let [a, b] = [of_way, &runs[0]].map(|of_way| all_masses_kg(of_way));
        let chance = by_chance(a.len(), b.len());
        let [number, mass] = [|_| 1.0, |kg| kg].map(|weight| distance(&a, &b, weight));
        table.row([
            format!("{number:.3} (by chance, in one of twenty cases: {chance:.3})"),
            format!("{mass:.2}"),
        ]);
    }
}

fn run(bench: &Bench, name: &str, seed: usize) -> Result<Run, Failed> {
    let mut options = sets(&[format!("run.seed={seed}")]);
    options.push(ONE_THREAD.to_owned());
    let scene = format!("data/scenes/{name}.toml");
    let run = bench.run(&format!("{name}-{seed}"), &scene, &options)?;
    let population = run.summary.population.as_ref();
    Ok(Run {
        processor_s: run.processor_s(),
        energy_error: run.summary.energy_error,
        left_out: population.map_or(f64::NAN, |all| all.bond_updates_skipped),
        masses_kg: masses_kg(Pieces::Left, &run.folder)?,
    })
}

fn all_masses_kg(runs: &[Run]) -> Vec<f64> {
    let masses = runs.iter().flat_map(|run| run.masses_kg.iter().copied());
    masses.collect()
}

/// Smallest to largest distance of pairs of runs, by number and by mass.
fn pairs(a: &[Run], b: &[Run], counts: impl Fn(usize, usize) -> bool) -> [String; 2] {
    [|_| 1.0, |kg| kg].map(|weight: fn(f64) -> f64| {
        let mut apart = Vec::new();
        for (i, a) in a.iter().enumerate() {
            for (_, b) in b.iter().enumerate().filter(|(j, _)| counts(i, *j)) {
                apart.push(distance(&a.masses_kg, &b.masses_kg, weight));
            }
        }
        let [least, most] = ends(&apart);
        format!("{least:.3} to {most:.3}")
    })
}
