//! Writes the tables of doc/process.md: the process with and without replacement, over the size of
//! the spheres, and its mass flows. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example process_tables
//! cargo run --release -p dem-run --example process_tables -- keep
//! ```
//!
//! Builds the programs and takes 40 minutes of one core; with `keep`, runs that ended before are
//! not done again. Results are in `target/process`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints tables, and how far it is"
)]

mod programs;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::process::Command;

use dem_results::read_series;
use serde_json::Value;

use programs::study::{Table, run_scene_or_keep};
use programs::{Failed, Programs, output, results};

const PAGE: &str = "doc/process.md";
/// Cakes and lumps can break.
const BREAKABLE: [&str; 2] = ["cake", "lump"];
/// How they are bonded: words, and the text of their `[replacement]`.
const WAYS: [(&str, &str); 4] = [
    ("rigid throughout", "{ when = { time = \"1000 s\" } }"),
    (
        "replaced at the plate, and restored behind it",
        "{ when = { enters = \"impact\" }, restore = { leaves = \"impact\", min_particles = 2, strain_energy = \"1 J/kg\", fluctuation_velocity = \"0.2 m/s\" } }",
    ),
    (
        "replaced at the plate",
        "{ when = { enters = \"impact\" } }",
    ),
    ("bonded from the start", "{ when = { time = 0 } }"),
];
const STATIC: &str = "bonds.cake.failure.rate_strengthening=false";
/// Diameters of the spheres of cakes and lumps: those of the scene last.
const DIAMETERS: [&str; 4] = ["15mm..18mm", "12mm..15mm", "10mm..12.5mm", "8mm..10mm"];
/// Seeds of the runs with and without the DIF.
const SEEDS: std::ops::RangeInclusive<u32> = 1..=10;
/// Those of the comparison of ways, and of the run with 300 bodies.
const OF_WAYS: &str = DIAMETERS[1];
const OF_MINUTE: &str = DIAMETERS[0];
/// The runs with 300 bodies: their product belts, and what else they set.
const PRODUCT_BELTS: [&str; 2] = ["0.1 m/s", "20 mm/s"];
const MINUTE: [&str; 5] = [
    "run.end_time=\"60 s\"",
    "measures.mixing.cell_size=\"0.3 m\"",
    "output.frames=\"5 s\"",
    "output.series=\"0.1 s\"",
    "output.pictures=\"2 s\"",
];
/// Its belts: speeds, m/s, and lengths of their regions, m.
const BELTS: [(&str, f64, f64); 2] = [
    ("mass_on_belt", 3.0, 0.7),
    ("mass_on_product_belt", 0.1, 0.4),
];
/// Its steady part, s: whole periods of all inlets.
const STEADY_S: [f64; 2] = [20.0, 60.0];

/// A finished run.
struct Run {
    folder: PathBuf,
    summary: Value,
}

impl Run {
    fn number(&self, pointer: &str) -> f64 {
        let found = self.summary.pointer(pointer).and_then(Value::as_f64);
        found.unwrap_or(f64::NAN)
    }

    /// d10, d50 and d80 of all its pieces of a body, as text in mm.
    fn sizes(&self, body: &str) -> String {
        let size = |d: &str| {
            let size_m = self.number(&format!("/sizes/bodies/{body}/both/{d}_m"));
            format!("{:.0}", 1e3 * size_m)
        };
        ["d10", "d50", "d80"].map(size).join(", ")
    }

    /// Mass that has left through the outlet `product`, as text.
    fn left_with_the_product(&self) -> String {
        let mass_kg = self.number("/population/outlets/product/mass_kg");
        format!("{mass_kg:.1} kg")
    }

    /// Times, s, and values of a column of the time series.
    fn column(&self, name: &str) -> Result<Vec<(f64, f64)>, Failed> {
        let series = read_series(&self.folder.join("series.csv"))?;
        let at = series.columns.iter().position(|column| column == name);
        let values = &series.values[at.ok_or("no such column")?];
        Ok(series
            .times_s
            .iter()
            .copied()
            .zip(values.iter().copied())
            .collect())
    }

    /// Mean of a measure over the steady part, kg.
    fn mean_of(&self, measure: &str) -> Result<f64, Failed> {
        let rows = self.column(&format!("{measure}_kg"))?.into_iter();
        let [from_s, to_s] = STEADY_S;
        let steady = rows.filter(|(time_s, _)| (from_s..to_s).contains(time_s));
        let steady: Vec<f64> = steady.map(|(_, value)| value).collect();
        Ok(steady.iter().sum::<f64>() / steady.len() as f64)
    }

    /// Sum over all bodies of a value of `flows`.
    fn flow_kg(&self, of: impl Fn(&Value) -> f64) -> f64 {
        let flows = self.summary["flows"].as_object().into_iter().flatten();
        flows.map(|(_, flow)| of(flow)).sum()
    }
}

/// Runs of the scene into the folder of results.
struct Runs {
    dem_run: PathBuf,
    folder: PathBuf,
    /// Whether runs that ended before are kept.
    keeps: bool,
}

impl Runs {
    /// The file of a body of spheres with these diameters.
    fn body(&self, body: &str, diameters: &str) -> PathBuf {
        self.folder.join(format!("{body}-{diameters}.vtp"))
    }

    /// Broken bonds of a run, and their fraction of the bonds of all bodies fed, as text.
    fn broken(&self, run: &Run, diameters: &str) -> Result<String, Failed> {
        let mut bonds = 0.0;
        for body in BREAKABLE {
            let own = dem_io::body::read_body(&self.body(body, diameters))?
                .bonds
                .len();
            bonds += own as f64 * run.number(&format!("/flows/{body}/fed"));
        }
        let broken = run.number("/broken_bonds");
        Ok(format!("{broken:.0} ({:.0} %)", 100.0 * broken / bonds))
    }

    /// Runs the scene with these values, and cakes and lumps of spheres with these diameters, on
    /// one thread.
    fn run(&self, out: &str, diameters: &str, set: &[String]) -> Result<Run, Failed> {
        let folder = self.folder.join(out);
        let mut options: Vec<String> = set.iter().map(|set| format!("--set={set}")).collect();
        for body in BREAKABLE {
            let file = self.body(body, diameters);
            options.push(format!("--body={body}={}", file.display()));
        }
        options.extend(["--threads", "1"].map(str::to_owned));
        let summary = run_scene_or_keep(&self.dem_run, "process", &options, &folder, self.keeps)?;
        Ok(Run { folder, summary })
    }
}

fn main() -> Result<(), Failed> {
    let programs = Programs::build()?;
    let runs = Runs {
        dem_run: programs.dem_run,
        folder: results("process")?,
        keeps: std::env::args().any(|word| word == "keep"),
    };
    for diameters in DIAMETERS {
        for (body, shape) in BREAKABLE.iter().zip(["filter-cake", "bar"]) {
            let file = runs.body(body, diameters);
            if runs.keeps && file.is_file() {
                continue;
            }
            let mut pack = Command::new(&programs.dem_pack);
            pack.arg(format!("data/shapes/{shape}.stl"));
            pack.args(["--diameter", diameters, "--overlap", "0.25"]);
            pack.args(["--bond-range", "1.1", "--seed", "3", "--quiet", "-o"]);
            output(pack.arg(&file))?;
        }
    }
    write_waiting(&runs)?;
    write_ways(&runs)?;
    write_sizes(&runs)?;
    write_seeds(&runs)?;
    let minute = |speed: &str| {
        let belt = format!("walls.product-belt.surface_velocity=[\"{speed}\",0,0]");
        let set: Vec<String> = MINUTE
            .map(str::to_owned)
            .into_iter()
            .chain([belt])
            .collect();
        let name = format!("minute-{}", speed.replace([' ', '/'], "-"));
        runs.run(&name, OF_MINUTE, &set)
    };
    let [fast, slow] = PRODUCT_BELTS.map(minute);
    let [fast, slow] = [fast?, slow?];
    write_minute([&fast, &slow])?;
    write_flows(&fast)?;
    write_mixing([&fast, &slow])?;
    write_sieves(&fast)
}

fn write_ways(runs: &Runs) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "cakes and lumps are",
        "DIF",
        "processor time",
        "bonds broken",
        "pieces",
        "cake: d10, d50, d80, mm",
        "lump: d10, d50, d80, mm",
        "left with the product",
        "energy error",
    ]);
    for (number, (words, replacement)) in WAYS.iter().enumerate() {
        for has_dif in [true, false] {
            if number == 0 && !has_dif {
                continue;
            }
            let mut set: Vec<String> = (BREAKABLE.iter())
                .map(|body| format!("replacement.{body}={replacement}"))
                .collect();
            if !has_dif {
                set.push(STATIC.to_owned());
            }
            let found = runs.run(&format!("way-{number}-{has_dif}"), OF_WAYS, &set)?;
            table.row(&[
                (*words).to_owned(),
                if has_dif { "yes" } else { "no" }.to_owned(),
                format!("{:.0} s", found.number("/processor_s")),
                runs.broken(&found, OF_WAYS)?,
                format!("{:.0}", found.number("/fragments/count")),
                found.sizes("cake"),
                found.sizes("lump"),
                found.left_with_the_product(),
                format!("{:.1e}", found.number("/energy_error")),
            ]);
        }
    }
    table.write(PAGE, "process_tables: ways")
}

fn write_sizes(runs: &Runs) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "spheres",
        "of a cake, of a lump",
        "DIF",
        "time step",
        "processor time",
        "bonds broken",
        "cake: d10, d50, d80, mm",
        "lump: d10, d50, d80, mm",
        "left with the product",
        "energy error",
    ]);
    for diameters in DIAMETERS {
        let count = |body: &str| -> Result<String, Failed> {
            let made = dem_io::body::read_body(&runs.body(body, diameters))?;
            Ok(made.radii.len().to_string())
        };
        let counts = format!("{}, {}", count("cake")?, count("lump")?);
        let range = diameters.replace("..", " to ").replace("mm", " mm");
        for has_dif in [true, false] {
            let set: &[String] = if has_dif { &[] } else { &[STATIC.to_owned()] };
            let found = runs.run(&format!("size-{diameters}-{has_dif}"), diameters, set)?;
            table.row(&[
                range.clone(),
                counts.clone(),
                if has_dif { "yes" } else { "no" }.to_owned(),
                format!("{:.1} us", 1e6 * found.number("/time_step_s")),
                format!("{:.0} s", found.number("/processor_s")),
                runs.broken(&found, diameters)?,
                found.sizes("cake"),
                found.sizes("lump"),
                found.left_with_the_product(),
                format!("{:.1e}", found.number("/energy_error")),
            ]);
        }
    }
    table.write(PAGE, "process_tables: sizes")
}

/// Mean over the seeds with and without the DIF, with the standard error, and the difference.
fn write_seeds(runs: &Runs) -> Result<(), Failed> {
    let mut found: Vec<Vec<Run>> = Vec::new();
    for has_dif in [true, false] {
        let mut of_seeds = Vec::new();
        for seed in SEEDS {
            let mut set = vec![format!("run.seed={seed}")];
            if !has_dif {
                set.push(STATIC.to_owned());
            }
            of_seeds.push(runs.run(&format!("seed-{seed}-{has_dif}"), OF_WAYS, &set)?);
        }
        found.push(of_seeds);
    }
    let mut table = Table::new(&[
        "mean of ten runs",
        "with the DIF",
        "without",
        "difference",
        "standard errors",
    ]);
    for (what, pointer, scale) in [
        ("bonds broken", "/broken_bonds", 1.0),
        ("cake: d10, mm", "/sizes/bodies/cake/both/d10_m", 1e3),
        ("cake: d50, mm", "/sizes/bodies/cake/both/d50_m", 1e3),
        ("lump: d10, mm", "/sizes/bodies/lump/both/d10_m", 1e3),
        ("lump: d50, mm", "/sizes/bodies/lump/both/d50_m", 1e3),
    ] {
        let [with, without] = [0, 1].map(|way| {
            let values = found[way].iter().map(|run| scale * run.number(pointer));
            mean_and_error(&values.collect::<Vec<_>>())
        });
        let (difference, error) = (with.0 - without.0, with.1.hypot(without.1));
        table.row(&[
            what.to_owned(),
            format!("{:.1} +- {:.1}", with.0, with.1),
            format!("{:.1} +- {:.1}", without.0, without.1),
            format!("{difference:+.1}"),
            format!("{:+.1}", difference / error),
        ]);
    }
    table.write(PAGE, "process_tables: seeds")
}

/// The mean of these values, and its standard error.
fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values.iter().map(|value| (value - mean).powi(2));
    let variance = squares.sum::<f64>() / (count - 1.0);
    (mean, (variance / count).sqrt())
}

/// Mass flows of its steady part.
fn write_flows(run: &Run) -> Result<(), Failed> {
    let mut table = Table::new(&["mass flow", "kg/s"]);
    let mut row = |what: String, flow_kg_s: f64| table.row(&[what, format!("{flow_kg_s:.3}")]);
    let mass_kg = |body: &str| run.number(&format!("/bodies/{body}/mass_kg"));
    let fed = ["cake", "lump", "rock"].map(|body| rate(body) * mass_kg(body));
    row(
        "fed: cakes and lumps, rates times masses".to_owned(),
        fed[0] + fed[1],
    );
    row("fed: rock".to_owned(), fed[2]);
    for (measure, speed_m_s, length_m) in BELTS {
        let flow_kg_s = run.mean_of(measure)? / length_m * speed_m_s;
        let what = format!("`{measure}` over {length_m} m, times {speed_m_s} m/s");
        row(what, flow_kg_s);
    }
    let left = discharged(run)?;
    for (body, flow_kg_s) in &left {
        row(format!("discharged through `product`: {body}"), *flow_kg_s);
    }
    row(
        "discharged through `product`, in all".to_owned(),
        left.values().sum(),
    );
    table.write(PAGE, "process_tables: flows")
}

/// What waste rock costs that waits to be fed, or lies on a floor: memory as `dem-run check` tells
/// it, and processor time of a step.
fn write_waiting(runs: &Runs) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "pieces of waste rock",
        "wait in an inlet",
        "",
        "lie on a floor",
        "",
    ]);
    table.row(&["", "memory", "a step", "memory", "a step"].map(str::to_owned));
    for count in [10, 100, 1000, 10_000] {
        let mut cells = vec![count.to_string()];
        for lies in [false, true] {
            let file = runs.folder.join(format!("waiting-{count}-{lies}.toml"));
            std::fs::write(&file, waiting(count, lies))?;
            let mut check = Command::new(&runs.dem_run);
            let told = output(check.arg("check").arg(&file).args(["--json", "--quiet"]))?;
            let told: Value = serde_json::from_slice(&told)?;
            let bytes = told["memory_bytes"].as_f64().unwrap_or(f64::NAN);
            cells.push(format!("{:.0} kB", 1e-3 * bytes));
            let mut run = Command::new(&runs.dem_run);
            run.arg(&file).args(["--json", "--quiet", "--threads", "1"]);
            let told: Value = serde_json::from_slice(&output(&mut run)?)?;
            let number = |name: &str| told[name].as_f64().unwrap_or(f64::NAN);
            let step_us = 1e6 * number("processor_s") / number("steps");
            cells.push(format!("{step_us:.1} us"));
        }
        table.row(&cells);
    }
    table.write(PAGE, "process_tables: waiting")
}

/// A scene of so many pieces of waste rock.
fn waiting(count: usize, lies: bool) -> String {
    let rock = programs::root().join("data/bodies/waste-rock.vtp");
    let file = rock.display();
    let body = format!("file = '{file}'\nmaterial = \"rock\"\nstart_as = \"clump\"\n");
    let mut text = "version = 1\n\
         [run]\nend_time = \"0.1 s\"\ngravity = [0, 0, -9.81]\n\
         [materials.rock]\ndensity = 2700\nshear_modulus = \"10 MPa\"\npoisson_ratio = 0.3\n\
         [contacts]\nrock-rock = { restitution = 0.3, friction = 0.5 }\n\
         [walls.floor]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = \"rock\"\n"
        .to_owned();
    if !lies {
        return text
            + &format!(
                "[bodies.rock]\n{body}[regions.gate]\nbox = {{ min = [0, 0, 1], max = [1, 1, 2] }}\n\
                 [inlets.gate]\nbodies = [\"rock\"]\nregion = \"gate\"\nrate = 1\nstart = \"1 h\"\ncount = {count}\n"
            );
    }
    let side = (count as f64).sqrt().ceil() as usize;
    for number in 0..count {
        let [x, y] = [number % side, number / side].map(|n| 0.1 * n as f64);
        text += &format!("[bodies.rock{number}]\n{body}position = [{x:?}, {y:?}, 0.0227]\n");
    }
    text
}

/// What the bin holds every ten seconds.
fn write_mixing(found: [&Run; 2]) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "time",
        "product belt",
        "pieces in the scene",
        "mass in the bin",
        "Lacey's index",
    ]);
    for (run, speed) in found.into_iter().zip(PRODUCT_BELTS) {
        let columns = ["pieces", "mass_in_bin_kg", "mixing"];
        let [pieces, mass, mixing] = columns.map(|name| run.column(name));
        let [pieces, mass, mixing] = [pieces?, mass?, mixing?];
        for number in 1..=6 {
            let wanted_s = 10.0 * f64::from(number);
            let mut times = pieces.iter();
            let at = times.position(|(time_s, _)| *time_s > wanted_s - 0.05);
            let at = at.ok_or("the run is too short")?;
            table.row(&[
                format!("{wanted_s:.0} s"),
                speed.to_owned(),
                format!("{:.0}", pieces[at].1),
                format!("{:.1} kg", mass[at].1),
                format!("{:.2}", mixing[at].1),
            ]);
        }
    }
    table.write(PAGE, "process_tables: mixing")
}

/// Sieve classes of cakes and lumps.
fn write_sieves(run: &Run) -> Result<(), Failed> {
    let text = std::fs::read_to_string(run.folder.join("distribution.csv"))?;
    let mut passing: BTreeMap<(u64, String), String> = BTreeMap::new();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [body, location, sieve_m, _, fraction] = cells[..] else {
            return Err("distribution.csv has other columns".into());
        };
        let sieve_um = (1e6 * sieve_m.parse::<f64>()?).round() as u64;
        let percent = format!("{:.1} %", 100.0 * fraction.parse::<f64>()?);
        if location == "both" {
            passing.insert((sieve_um, body.to_owned()), percent);
        }
    }
    let mut table = Table::new(&["sieve", "passing: cake", "lump"]);
    let mut sieves_um: Vec<u64> = passing.keys().map(|(sieve_um, _)| *sieve_um).collect();
    sieves_um.dedup();
    for sieve_um in sieves_um {
        let of = |body: &str| passing.get(&(sieve_um, body.to_owned())).cloned();
        table.row(&[
            format!("{:.1} mm", sieve_um as f64 * 1e-3),
            of("cake").unwrap_or_default(),
            of("lump").unwrap_or_default(),
        ]);
    }
    table.write(PAGE, "process_tables: sieves")
}

/// Bodies per second of the inlets of the scene.
fn rate(body: &str) -> f64 {
    match body {
        "rock" => 2.0,
        _ => 1.5,
    }
}

/// Mass flow of each body through the outlet `product` in the steady part, kg/s.
fn discharged(run: &Run) -> Result<BTreeMap<String, f64>, Failed> {
    let text = std::fs::read_to_string(run.folder.join("discharge.csv"))?;
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let at = |name: &str| head.iter().position(|other| *other == name).unwrap_or(0);
    let [from_s, to_s] = STEADY_S;
    let mut flows: BTreeMap<String, f64> = BTreeMap::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let time_s: f64 = cells[at("time_s")].parse()?;
        if cells[at("outlet")] == "product" && (from_s..to_s).contains(&time_s) {
            let mass_kg: f64 = cells[at("mass_kg")].parse()?;
            *flows.entry(cells[at("body")].to_owned()).or_default() += mass_kg / (to_s - from_s);
        }
    }
    Ok(flows)
}

/// The runs with 300 bodies.
fn write_minute(found: [&Run; 2]) -> Result<(), Failed> {
    let [fast, slow] = PRODUCT_BELTS.map(|speed| format!("product belt {speed}"));
    let mut table = Table::new(&["a minute of the process", &fast, &slow]);
    let mut row = |what: &str, value: &dyn Fn(&Run) -> String| {
        let [fast, slow] = found.map(value);
        table.row(&[what.to_owned(), fast, slow]);
    };
    let count = |pointer: &'static str| move |run: &Run| format!("{:.0}", run.number(pointer));
    row("processor time, one thread", &|run| {
        format!("{:.1} min", run.number("/processor_s") / 60.0)
    });
    row("steps", &count("/steps"));
    row("bodies fed", &count("/population/fed"));
    row(
        "bodies and pieces inside at the end",
        &count("/fragments/inside"),
    );
    row("their mass, over that of a mean body", &|run| {
        let inside_kg = run.flow_kg(|flow| flow["inside_kg"].as_f64().unwrap_or(f64::NAN));
        let mean_kg = run.number("/population/fed_kg") / run.number("/population/fed");
        format!("{:.0}", inside_kg / mean_kg)
    });
    row("pieces discharged", &count("/population/discharged"));
    row("bonds broken", &count("/broken_bonds"));
    row("cake: d10, d50, d80", &|run| {
        format!("{} mm", run.sizes("cake"))
    });
    row("lump: d10, d50, d80", &|run| {
        format!("{} mm", run.sizes("lump"))
    });
    row("Lacey's index at the end", &|run| {
        format!("{:.2}", run.number("/measures/mixing/value"))
    });
    row("largest overlap, of the smaller radius", &|run| {
        format!("{:.2}", run.number("/largest_overlap"))
    });
    row("energy error", &|run| {
        format!("{:.1e}", run.number("/energy_error"))
    });
    row("fed, less left and inside", &|run| {
        let missing = run.flow_kg(|flow| flow["missing_kg"].as_f64().unwrap_or(f64::NAN).abs());
        format!("{missing:.1e} kg")
    });
    table.write(PAGE, "process_tables: minute")
}
