//! Writes the tables of doc/process.md: the process with and without replacement, over the size of
//! the spheres, and its mass flows. From the folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example process_tables
//! cargo run --release -p dem-run --example process_tables -- minute
//! ```
//!
//! Builds the programs. The first takes half an hour; the second runs 300 bodies for a minute.
//! Results are in `target/process`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints tables, and how far it is"
)]

#[allow(dead_code, reason = "other examples use the rest")]
mod programs;
#[allow(dead_code, reason = "other examples use the rest")]
#[path = "programs/study.rs"]
mod study;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use dem_results::read_series;
use serde_json::Value;

use programs::{Failed, Programs, output, results};
use study::{Table, run_scene};

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
/// Diameters of the spheres of cakes and lumps.
const DIAMETERS: [&str; 3] = ["12mm..15mm", "10mm..12.5mm", "8mm..10mm"];
/// The run with 300 bodies.
const MINUTE: [&str; 3] = [
    "run.end_time=\"60 s\"",
    "walls.product-belt.surface_velocity=[\"20 mm/s\",0,0]",
    "output.frames=\"5 s\"",
];
/// Speeds of the belts, m/s, and lengths of their regions, m.
const BELTS: [(&str, f64, f64); 2] = [
    ("mass_on_belt", 3.0, 0.7),
    ("mass_on_product_belt", 0.4, 0.4),
];
/// Steady part of the run, s: whole periods of all inlets.
const STEADY_S: [f64; 2] = [4.0, 8.0];

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

    /// Mean of a measure over the steady part, kg.
    fn mean_of(&self, measure: &str) -> Result<f64, Failed> {
        let series = read_series(&self.folder.join("series.csv"))?;
        let column = format!("{measure}_kg");
        let at = series.columns.iter().position(|name| *name == column);
        let values = &series.values[at.ok_or("no such measure")?];
        let [from_s, to_s] = STEADY_S;
        let rows = series.times_s.iter().zip(values);
        let steady = rows.filter(|(time_s, _)| (from_s..to_s).contains(*time_s));
        let steady: Vec<f64> = steady.map(|(_, value)| *value).collect();
        Ok(steady.iter().sum::<f64>() / steady.len() as f64)
    }

    /// Sum over all bodies of a value of `flows`.
    fn flow_kg(&self, of: impl Fn(&Value) -> f64) -> f64 {
        let flows = self.summary["flows"].as_object().into_iter().flatten();
        flows.map(|(_, flow)| of(flow)).sum()
    }
}

fn main() -> Result<(), Failed> {
    let folder = results("process")?;
    let programs = Programs::build()?;
    let minute = std::env::args().any(|word| word == "minute");
    if minute {
        return write_minute(&programs.dem_run, &folder);
    }
    let run = |out: &str, set: &[String], bodies: &[String]| -> Result<Run, Failed> {
        let mut options: Vec<String> = set.iter().map(|set| format!("--set={set}")).collect();
        options.extend(bodies.iter().map(|body| format!("--body={body}")));
        options.extend(["--threads", "2"].map(str::to_owned));
        let folder = folder.join(out);
        let summary = run_scene(&programs.dem_run, "process", &options, &folder)?;
        Ok(Run { folder, summary })
    };
    write_ways(&run)?;
    write_sizes(&programs.dem_pack, &folder, &run)?;
    write_flows(&run("steady", &[], &[])?)
}

/// Runs the scene into a folder, with values and bodies.
type Runs<'a> = &'a dyn Fn(&str, &[String], &[String]) -> Result<Run, Failed>;

fn write_ways(run: Runs<'_>) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "cakes and lumps are",
        "DIF",
        "processor time",
        "bonds broken",
        "pieces",
        "cake: d10, d50, d80, mm",
        "lump: d10, d50, d80, mm",
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
            let found = run(&format!("way-{number}-{has_dif}"), &set, &[])?;
            table.row(&[
                (*words).to_owned(),
                if has_dif { "yes" } else { "no" }.to_owned(),
                format!("{:.0} s", found.number("/processor_s")),
                format!("{:.0}", found.number("/broken_bonds")),
                format!(
                    "{:.0}",
                    found.number("/fragments/count") + found.number("/population/discharged")
                ),
                found.sizes("cake"),
                found.sizes("lump"),
                format!("{:.1e}", found.number("/energy_error")),
            ]);
        }
    }
    table.write(PAGE, "process_tables: ways")
}

fn write_sizes(dem_pack: &Path, folder: &Path, run: Runs<'_>) -> Result<(), Failed> {
    let mut table = Table::new(&[
        "spheres",
        "DIF",
        "of a cake, of a lump",
        "time step",
        "processor time",
        "bonds broken of those",
        "cake: d10, d50, d80, mm",
        "lump: d10, d50, d80, mm",
        "Lacey's index at the end",
    ]);
    for diameters in DIAMETERS {
        let mut bodies = Vec::new();
        let mut counts = Vec::new();
        for (body, shape) in BREAKABLE.iter().zip(["filter-cake", "bar"]) {
            let file = folder.join(format!("{body}-{diameters}.vtp"));
            let mut pack = Command::new(dem_pack);
            pack.arg(format!("data/shapes/{shape}.stl"));
            pack.args([
                "--diameter",
                diameters,
                "--overlap",
                "0.25",
                "--bond-range",
                "1.1",
            ]);
            pack.args(["--seed", "3", "--quiet", "-o"]).arg(&file);
            output(&mut pack)?;
            let made = dem_io::body::read_body(&file)?;
            counts.push(made.radii.len().to_string());
            bodies.push(format!("{body}={}", file.display()));
        }
        for has_dif in [true, false] {
            let set: &[String] = if has_dif { &[] } else { &[STATIC.to_owned()] };
            let found = run(&format!("size-{diameters}-{has_dif}"), set, &bodies)?;
            table.row(&[
                diameters
                    .replace("mm..", " mm to ")
                    .replace("mm", " mm")
                    .replace("  ", " "),
                if has_dif { "yes" } else { "no" }.to_owned(),
                counts.join(", "),
                format!("{:.1} us", 1e6 * found.number("/time_step_s")),
                format!("{:.0} s", found.number("/processor_s")),
                format!("{:.0}", found.number("/broken_bonds")),
                found.sizes("cake"),
                found.sizes("lump"),
                format!("{:.2}", found.number("/measures/mixing/value")),
            ]);
        }
    }
    table.write(PAGE, "process_tables: sizes")
}

fn write_flows(run: &Run) -> Result<(), Failed> {
    let fed_kg = run.flow_kg(|flow| flow["fed_kg"].as_f64().unwrap_or(f64::NAN));
    let mut table = Table::new(&["mass flow", "kg/s"]);
    for body in ["cake", "lump", "rock"] {
        let mass_kg = run.number(&format!("/bodies/{body}/mass_kg"));
        table.row(&[
            format!("fed: {body}, rate of its inlet times its mass"),
            format!("{:.3}", rate(body) * mass_kg),
        ]);
    }
    for (measure, speed_m_s, length_m) in BELTS {
        let flow_kg_s = run.mean_of(measure)? / length_m * speed_m_s;
        table.row(&[
            format!("`{measure}` over {length_m} m, times {speed_m_s} m/s"),
            format!("{flow_kg_s:.3}"),
        ]);
    }
    for (body, flow_kg_s) in discharged(run)? {
        table.row(&[format!("left: {body}"), format!("{flow_kg_s:.3}")]);
    }
    let missing = run.flow_kg(|flow| flow["missing_kg"].as_f64().unwrap_or(f64::NAN).abs());
    table.row(&[
        format!("fed, less left and inside, of {fed_kg:.3} kg"),
        format!("{missing:.1e} kg"),
    ]);
    table.write(PAGE, "process_tables: flows")
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

/// The run with 300 bodies.
fn write_minute(dem_run: &Path, folder: &Path) -> Result<(), Failed> {
    let mut options: Vec<String> = MINUTE.iter().map(|set| format!("--set={set}")).collect();
    options.extend(["--threads", "2"].map(str::to_owned));
    let folder = folder.join("minute");
    let summary = run_scene(dem_run, "process", &options, &folder)?;
    let run = Run { folder, summary };
    let mut table = Table::new(&["a minute of the process", ""]);
    let mut row = |what: &str, value: String| table.row(&[what.to_owned(), value]);
    row(
        "time on two cores",
        format!("{:.1} min", run.number("/wall_s") / 60.0),
    );
    row(
        "processor time",
        format!("{:.1} min", run.number("/processor_s") / 60.0),
    );
    row("steps", format!("{:.0}", run.number("/steps")));
    row(
        "bodies fed",
        format!("{:.0}", run.number("/population/fed")),
    );
    row(
        "bodies and pieces inside at the end",
        format!("{:.0}", run.number("/fragments/count")),
    );
    row(
        "pieces discharged",
        format!("{:.0}", run.number("/population/discharged")),
    );
    row(
        "bonds broken",
        format!("{:.0}", run.number("/broken_bonds")),
    );
    row("cake: d10, d50, d80", format!("{} mm", run.sizes("cake")));
    row("lump: d10, d50, d80", format!("{} mm", run.sizes("lump")));
    row(
        "Lacey's index in the bin at the end",
        format!("{:.2}", run.number("/measures/mixing/value")),
    );
    row(
        "energy error",
        format!("{:.1e}", run.number("/energy_error")),
    );
    let missing = run.flow_kg(|flow| flow["missing_kg"].as_f64().unwrap_or(f64::NAN).abs());
    row("fed, less left and inside", format!("{missing:.1e} kg"));
    table.write(PAGE, "process_tables: minute")
}
