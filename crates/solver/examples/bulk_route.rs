//! Writes the table of doc/bulk.md: from a poured density to the density of the particles, to the
//! overlap of a body, and back by shattering it (Platzer 2022, 3.1.1 and 4.5.1.5). From the folder
//! of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example bulk_route
//! ```
//!
//! Builds the program and takes some ten minutes. Results are in `target/bulk-route`.
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

use programs::study::{Table, measured, run_scene};
use programs::{Failed, Programs, results};

/// Densities of the material as a laboratory measures them, kg/m3: poured, and solid.
const BULK_KG_M3: f64 = 1200.0;
const SOLID_KG_M3: f64 = 1800.0;
/// Density of the particles with which the first pouring is run, kg/m3.
const TRIAL_KG_M3: f64 = 2050.0;
/// Diameters, as those of data/scenes/pour-box.toml.
const DIAMETERS: &str = "3.5mm..5mm";
const SEEDS: [u64; 3] = [1, 2, 3];

fn main() -> Result<(), Failed> {
    let folder = results("bulk-route")?;
    let dem_run = Programs::build()?.dem_run;
    let run = |scene: &str, set: &[String], bar: Option<&Path>, out: &str| {
        let mut options: Vec<String> = set.iter().map(|set| format!("--set={set}")).collect();
        options.extend(bar.map(|bar| format!("--body=bar={}", bar.display())));
        run_scene(&dem_run, scene, &options, &folder.join(out))
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
