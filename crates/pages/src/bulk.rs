//! doc/bulk.md. The route: from a poured density to the density of the particles, to the overlap of
//! a body, and back by shattering it (Platzer 2022, 3.1.1 and 4.5.1.5). The heaps: angles of repose
//! of beads that run out of a lifted tube, and of the same beads poured.

use std::path::Path;

use crate::bench::{Bench, Failed, Run, body, number, read, sets};
use crate::cells::{change, columns, mean, mean_and_range};
use crate::table::{Table, write};

const PAGE: &str = "doc/bulk.md";
/// Densities of the material as a laboratory measures them, kg/m3: poured, and solid.
const BULK_KG_M3: f64 = 1200.0;
const SOLID_KG_M3: f64 = 1800.0;
/// Density of the particles with which the first pouring is run, kg/m3.
const TRIAL_KG_M3: f64 = 2050.0;
/// Diameters, as those of data/scenes/pour-box.toml.
const DIAMETERS: &str = "3.5mm..5mm";
const SEEDS: [u64; 3] = [1, 2, 3];

/// Coefficients of rolling friction of the heaps.
const ROLLING: [f64; 3] = [0.2, 0.1, 0.05];

pub(crate) fn tables() -> [Table; 2] {
    let seeds = SEEDS.map(|seed| seed.to_string()).into_iter();
    let route = "seed | poured, at 2050 kg/m3 | particle density | overlap | solid density | \
        shattered: bulk density | off | bulking factor";
    let heaps = "rolling friction | lifted by 30 mm/s | lifted by 75 mm/s | poured | \
        bulk density in the tube | in the heap lifted by 30 mm/s";
    let rolling = ROLLING.map(|rolling| rolling.to_string());
    [
        Table::new(PAGE, "bulk route", route, seeds.chain(["mean".to_owned()])),
        Table::new(PAGE, "bulk heaps", heaps, rolling),
    ]
}

/// From a poured density to that of a solid and back.
#[allow(clippy::print_stdout, reason = "it prints a number of the page")]
pub(crate) fn route(bench: &Bench) -> Result<(), Failed> {
    let [mut table, _] = tables();
    let poured = of_seeds(|seed| {
        let set = sets(&[format!("run.seed={seed}")]);
        let run = bench.run(&format!("poured-{seed}"), "data/scenes/pour-box.toml", &set)?;
        run.measured("bulk_density")
    })?;
    // The particle density of the material: the mean of all pourings.
    let particle_kg_m3 = TRIAL_KG_M3 * BULK_KG_M3 / mean(&poured);
    let shatter = |name: &str, file: &Path, more: &[&str]| {
        let mut options = sets(&[format!("materials.cake.density={particle_kg_m3}")]);
        options.extend(sets(more));
        options.push(body("bar", file));
        bench.run(name, "data/scenes/shatter-box.toml", &options)
    };
    let mut bars = Vec::new();
    let shattered = of_seeds(|seed| {
        let options = [
            format!("--diameter={DIAMETERS}"),
            "--bond-range=1.0".to_owned(),
            format!("--particle-density={particle_kg_m3}"),
            format!("--solid-density={SOLID_KG_M3}"),
            format!("--seed={seed}"),
        ];
        let file = bench.pack(&format!("bar-{seed}"), "bar", &options)?;
        let report = read(&file.with_extension("json")).ok_or("no report")?;
        let made = |name: &str| number(&report["quality"][name]);
        let bulk = shatter(&format!("shattered-{seed}"), &file, &[])?;
        bars.push(file);
        let [bulk_kg_m3, factor] = ["bulk_density", "bulking_factor"].map(|of| bulk.measured(of));
        Ok([
            made("overlap"),
            made("solid_density_kg_m3"),
            bulk_kg_m3?,
            factor?,
        ])
    })?;
    let density = |kg_m3: f64| format!("{kg_m3:.0} kg/m3");
    let off = |bulk_kg_m3: f64| change(bulk_kg_m3 / BULK_KG_M3 - 1.0, 1);
    for (poured_kg_m3, [overlap, solid_kg_m3, bulk_kg_m3, factor]) in poured.iter().zip(&shattered)
    {
        table.row([
            density(*poured_kg_m3),
            density(particle_kg_m3),
            format!("{overlap:.3}"),
            density(*solid_kg_m3),
            density(*bulk_kg_m3),
            off(*bulk_kg_m3),
            format!("{factor:.3}"),
        ]);
    }
    let [_, _, back, _] = columns(&shattered, mean);
    let (poured, particles, back_off) =
        (density(mean(&poured)), density(particle_kg_m3), off(back));
    let none = String::new;
    table.row([
        poured,
        particles,
        none(),
        none(),
        density(back),
        back_off,
        none(),
    ]);
    write(&[table])?;

    // The same body, which breaks where it lies.
    let set = [
        "bodies.bar.position=[0,0,\"0.1 mm\"]",
        "regions.bed.box.max=[\"15 mm\",\"15 mm\",\"15 mm\"]",
        "regions.bed.box.min=[\"-15 mm\",\"-15 mm\",\"6 mm\"]",
    ];
    let lying = shatter("lying", &bars[0], &set)?.measured("bulk_density")?;
    println!("\nBroken on the floor, below the bars: {lying:.0} kg/m3.");
    Ok(())
}

/// Ways to make a heap of 1,500 beads: the scene, a word for the folder, the contacts that roll,
/// and what else is set. The scene lifts the tube by 30 mm/s.
type Way = (
    &'static str,
    &'static str,
    &'static [&'static str],
    &'static [&'static str],
);

const BEADS: [&str; 2] = ["bead-bead", "bead-plate"];
const WAYS: [Way; 3] = [
    ("lifted-cylinder", "lifted-30", &BEADS, &[]),
    ("lifted-cylinder", "lifted-75", &BEADS, &FASTER),
    ("wet-heap", "poured", &["glass-glass"], &POURED),
];

/// Settings with which the tube is lifted by 75 mm/s.
const FASTER: [&str; 2] = [
    "walls.tube.table=[[\"0.5 s\",0],[\"1.3 s\",1]]",
    "run.end_time=\"1.6 s\"",
];

/// Settings with which `wet-heap.toml` pours 1,500 dry beads of `lifted-cylinder.toml`.
const POURED: [&str; 10] = [
    "contacts.glass-glass.liquid_bridge.surface_tension=1e-9",
    "contacts.glass-glass.friction=0.5",
    "contacts.glass-glass.restitution=0.4",
    "materials.glass.young_modulus=\"2 MPa\"",
    "bodies.bead.particles=[[0,0,0,\"2 mm\"]]",
    "regions.gate.box={min=[\"-10 mm\",\"-10 mm\",\"45 mm\"],max=[\"10 mm\",\"10 mm\",\"65 mm\"]}",
    "inlets.pour.count=1500",
    "inlets.pour.rate=\"1000 /s\"",
    "inlets.pour.end=\"2 s\"",
    "run.end_time=\"2.2 s\"",
];

/// Angles of repose of lifted and poured heaps.
pub(crate) fn heaps(bench: &Bench) -> Result<(), Failed> {
    let [_, mut table] = tables();
    for rolling in ROLLING {
        let runs = |(scene, word, contacts, more): Way| {
            of_seeds(|seed| {
                let rolls = |on: &&str| format!("contacts.{on}.rolling_friction={rolling}");
                let mut set: Vec<String> = contacts.iter().map(rolls).collect();
                set.extend(more.iter().map(|&set| set.to_owned()));
                set.push(format!("run.seed={seed}"));
                let name = format!("{word}-{rolling}-{seed}");
                bench.run(&name, &format!("data/scenes/{scene}.toml"), &sets(&set))
            })
        };
        let [lifted, fast, poured] = WAYS.map(runs);
        let (lifted, fast, poured) = (lifted?, fast?, poured?);
        let angle = |of: &[Run]| of_runs(of, "angle_of_repose", "degrees", 1);
        let density = |name: &str| of_runs(&lifted, name, "kg/m3", 0);
        table.row([
            angle(&lifted)?,
            angle(&fast)?,
            angle(&poured)?,
            density("poured_bulk_density")?,
            density("heap_bulk_density")?,
        ]);
    }
    write(&[table])
}

/// The results of some work for each seed.
fn of_seeds<T>(work: impl FnMut(u64) -> Result<T, Failed>) -> Result<Vec<T>, Failed> {
    SEEDS.into_iter().map(work).collect()
}

/// Mean of a measure over runs, and its smallest and largest value.
fn of_runs(runs: &[Run], measure: &str, unit: &str, digits: usize) -> Result<String, Failed> {
    let values = runs.iter().map(|run| run.measured(measure));
    let values: Vec<f64> = values.collect::<Result<_, _>>()?;
    Ok(mean_and_range(&values, unit, digits))
}
