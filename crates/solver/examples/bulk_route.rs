//! Writes the tables of doc/bulk.md. `route`: from a poured density to the density of the
//! particles, to the overlap of a body, and back by shattering it (Platzer 2022, 3.1.1 and
//! 4.5.1.5). `heaps`: angles of repose of beads that run out of a lifted tube, and of the same
//! beads poured. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example bulk_route -- route
//! cargo run --release -p dem-run --example bulk_route -- heaps
//! ```
//!
//! Builds the program and takes ten to fifteen minutes each. Results are in `target/bulk-route`;
//! `--resume` at the end keeps the complete runs of the heaps.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod programs;

use std::path::Path;

use dem_io::body::mass::of_named_density;
use dem_io::body::write_body;
use dem_io::surface::{ReadSettings, surface_from_stl};
use dem_pack::{Basis, BodySettings, BondSettings, PackSettings, Sizes, make_body};
use serde_json::Value;

use programs::study::{Table, mean_and_range, measured, run_scene, run_scene_or_keep};
use programs::{Failed, Programs, results};

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

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let keeps = words.iter().any(|word| word == "--resume");
    let folder = results("bulk-route")?;
    let dem_run = Programs::build()?.dem_run;
    match words.first().map(String::as_str) {
        Some("route") => route(&dem_run, &folder),
        Some("heaps") => heaps(&dem_run, &folder, keeps),
        _ => Err("say which table: route or heaps".into()),
    }
}

/// Table of the route from a poured density to that of a solid and back.
fn route(dem_run: &Path, folder: &Path) -> Result<(), Failed> {
    let run = |scene: &str, set: &[String], bar: Option<&Path>, out: &str| {
        let mut options: Vec<String> = set.iter().map(|set| format!("--set={set}")).collect();
        options.extend(bar.map(|bar| format!("--body=bar={}", bar.display())));
        run_scene(dem_run, scene, &options, &folder.join(out))
    };
    let mut table = Table::new(&[
        "seed",
        "poured, at 2050 kg/m3",
        "particle density",
        "overlap",
        "solid density",
        "shattered: bulk density",
        "off",
        "bulking factor",
    ]);
    let poured = at_once(|seed| {
        let set = [format!("run.seed={seed}")];
        let out = format!("poured-{seed}");
        measured(&run("pour-box", &set, None, &out)?, "bulk_density")
    })?;
    // The particle density of the material: the mean of all pourings.
    let poured_kg_m3 = poured.iter().sum::<f64>() / poured.len() as f64;
    let particle_kg_m3 = TRIAL_KG_M3 * BULK_KG_M3 / poured_kg_m3;
    let shattered = at_once(|seed| {
        let file = folder.join(format!("bar-{seed}.vtp"));
        let (overlap, solid_kg_m3) = pack(seed, particle_kg_m3, &file)?;
        let set = [format!("materials.cake.density={particle_kg_m3}")];
        let out = format!("shattered-{seed}");
        let bulk = run("shatter-box", &set, Some(&file), &out)?;
        let [bulk_kg_m3, factor] = [
            measured(&bulk, "bulk_density")?,
            measured(&bulk, "bulking_factor")?,
        ];
        Ok([overlap, solid_kg_m3, bulk_kg_m3, factor])
    })?;
    for ((seed, poured_kg_m3), of_seed) in SEEDS.iter().zip(&poured).zip(&shattered) {
        let [overlap, solid_kg_m3, bulk_kg_m3, factor] = of_seed;
        table.row(&[
            seed.to_string(),
            format!("{poured_kg_m3:.0} kg/m3"),
            format!("{particle_kg_m3:.0} kg/m3"),
            format!("{overlap:.3}"),
            format!("{solid_kg_m3:.0} kg/m3"),
            format!("{bulk_kg_m3:.0} kg/m3"),
            format!("{:+.1} %", 100.0 * (bulk_kg_m3 / BULK_KG_M3 - 1.0)),
            format!("{factor:.3}"),
        ]);
    }
    let back = shattered.iter().map(|[_, _, bulk_kg_m3, _]| bulk_kg_m3);
    let mean = back.sum::<f64>() / SEEDS.len() as f64;
    let off = 100.0 * (mean / BULK_KG_M3 - 1.0);
    table.row(&[
        "mean".to_owned(),
        format!("{poured_kg_m3:.0} kg/m3"),
        format!("{particle_kg_m3:.0} kg/m3"),
        String::new(),
        String::new(),
        format!("{mean:.0} kg/m3"),
        format!("{off:+.1} %"),
        String::new(),
    ]);
    table.write("doc/bulk.md", "bulk_route")?;

    // The same body, which breaks where it lies.
    let set = [
        format!("materials.cake.density={particle_kg_m3}"),
        "bodies.bar.position=[0,0,\"0.1 mm\"]".to_owned(),
        "regions.bed.box.max=[\"15 mm\",\"15 mm\",\"15 mm\"]".to_owned(),
        "regions.bed.box.min=[\"-15 mm\",\"-15 mm\",\"6 mm\"]".to_owned(),
    ];
    let file = folder.join(format!("bar-{}.vtp", SEEDS[0]));
    let lying = run("shatter-box", &set, Some(&file), "lying")?;
    println!(
        "\nBroken on the floor, below the bars: {:.0} kg/m3.",
        measured(&lying, "bulk_density")?
    );
    Ok(())
}

/// Ways to make a heap of 1,500 beads.
#[derive(Clone, Copy)]
enum Way {
    /// data/scenes/lifted-cylinder.toml, lifted by 30 mm/s.
    Lifted,
    /// By 75 mm/s.
    LiftedFast,
    /// data/scenes/wet-heap.toml, dry and with the beads of the other scene.
    Poured,
}

impl Way {
    /// The scene, a word for the folder, and the options.
    fn options(self, rolling: f64, seed: u64) -> (&'static str, &'static str, Vec<String>) {
        let lifted =
            ["bead", "plate"].map(|on| format!("contacts.bead-{on}.rolling_friction={rolling}"));
        let (scene, word, mut set) = match self {
            Self::Lifted => ("lifted-cylinder", "lifted-30", lifted.to_vec()),
            Self::LiftedFast => {
                let faster = [
                    "walls.tube.table=[[\"0.5 s\",0],[\"1.3 s\",1]]",
                    "run.end_time=\"1.6 s\"",
                ];
                let set = lifted.into_iter().chain(faster.map(str::to_owned));
                ("lifted-cylinder", "lifted-75", set.collect())
            }
            Self::Poured => {
                let rolling = format!("contacts.glass-glass.rolling_friction={rolling}");
                let set = [rolling].into_iter().chain(POURED.map(str::to_owned));
                ("wet-heap", "poured", set.collect())
            }
        };
        set.push(format!("run.seed={seed}"));
        let options = set.iter().map(|set| format!("--set={set}")).collect();
        (scene, word, options)
    }
}

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

/// Table of the angles of repose of lifted and poured heaps.
fn heaps(dem_run: &Path, folder: &Path, keeps: bool) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "rolling friction",
        "lifted by 30 mm/s",
        "lifted by 75 mm/s",
        "poured",
        "bulk density in the tube",
        "in the heap lifted by 30 mm/s",
    ]);
    for rolling in ROLLING {
        let summaries = |way: Way| {
            at_once(|seed| {
                let (scene, word, mut options) = way.options(rolling, seed);
                options.push("--threads=1".to_owned());
                let folder = folder.join(format!("{word}-{rolling}-{seed}"));
                run_scene_or_keep(dem_run, scene, &options, &folder, keeps)
            })
        };
        let [lifted, fast, poured] = [
            summaries(Way::Lifted)?,
            summaries(Way::LiftedFast)?,
            summaries(Way::Poured)?,
        ];
        let angle = |of: &[Value]| of_runs(of, "angle_of_repose", "degrees", 1);
        let density = |name: &str| of_runs(&lifted, name, "kg/m3", 0);
        table.row(&[
            rolling.to_string(),
            angle(&lifted)?,
            angle(&fast)?,
            angle(&poured)?,
            density("poured_bulk_density")?,
            density("heap_bulk_density")?,
        ]);
    }
    table.write("doc/bulk.md", "bulk_route heaps")
}

/// Mean of a measure over runs, and its smallest and largest value.
fn of_runs(
    summaries: &[Value],
    measure: &str,
    unit: &str,
    decimals: usize,
) -> Result<String, Failed> {
    let values = summaries.iter().map(|summary| measured(summary, measure));
    let values: Vec<f64> = values.collect::<Result<_, _>>()?;
    Ok(mean_and_range(&values, unit, decimals))
}

/// The results of some work for each seed, all at once.
fn at_once<T: Send>(work: impl Fn(u64) -> Result<T, Failed> + Sync) -> Result<Vec<T>, Failed> {
    let done: Vec<Result<T, String>> = std::thread::scope(|scope| {
        let work = &work;
        let spawn = |seed| scope.spawn(move || work(seed).map_err(|error| error.to_string()));
        let threads: Vec<_> = SEEDS.map(spawn).into();
        let join = |thread: std::thread::ScopedJoinHandle<'_, Result<T, String>>| {
            thread
                .join()
                .unwrap_or_else(|_| Err("a thread failed".to_owned()))
        };
        threads.into_iter().map(join).collect()
    });
    done.into_iter()
        .map(|result| result.map_err(Failed::from))
        .collect()
}

/// Packs the bar so that it has the solid density. Returns its overlap and its solid density,
/// kg/m3.
fn pack(seed: u64, particle_kg_m3: f64, file: &Path) -> Result<(f64, f64), Failed> {
    let stl = concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/shapes/bar.stl");
    let reading = ReadSettings {
        unit_m: 1e-3,
        scale: 1.0,
        fill_holes: false,
    };
    let surface = surface_from_stl(&std::fs::read(stl)?, "bar.stl", reading)?;
    let settings = BodySettings {
        bonds: BondSettings {
            range: 1.0,
            ..BondSettings::default()
        },
        particle_density_kg_m3: Some(particle_kg_m3),
        solid_density_kg_m3: Some(SOLID_KG_M3),
        ..BodySettings::new(PackSettings {
            seed,
            ..PackSettings::new(Sizes::parse(DIAMETERS, Basis::Number)?)
        })
    };
    let (body, made) = make_body(&surface, &settings, &|_, _| Ok(()))?;
    write_body(&body, file)?;
    let solid = of_named_density(&body).and_then(|mass| mass.solid_density_kg_m3);
    Ok((made.quality.overlap, solid.ok_or("no density")?))
}
