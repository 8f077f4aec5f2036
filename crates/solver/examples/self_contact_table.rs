//! Writes the table of doc/self-contact.md: scenes with and without contacts within pieces. From
//! the
//! folder of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example self_contact_table
//! ```
//!
//! Builds the program and takes some ten minutes, on one thread. Results are in
//! `target/self-contact-table`.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod programs;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use dem_scene::study::Pieces;
use dem_study::masses::{by_chance, distance, masses_kg};
use serde_json::Value;

use programs::study::{Table, mean_and_range, measured, run_file, run_scene};
use programs::{Failed, Programs, results};

const PAGE: &str = "doc/self-contact.md";
const WAYS: [&str; 2] = ["false", "true"];
/// Seeds of the chute.
const SEEDS: usize = 4;
/// Spheres of the slit block along each side, and their radius, m.
const BLOCK: [usize; 3] = [5, 5, 10];
const RADIUS_M: f64 = 1e-3;

/// Scenes and their results, each way.
struct Bench {
    dem_run: PathBuf,
    folder: PathBuf,
    table: Table,
}

fn main() -> Result<(), Failed> {
    let mut bench = Bench {
        dem_run: Programs::build()?.dem_run,
        folder: results("self-contact-table")?,
        table: Table::new(&["scene", "", "never", "`self_contact`"]),
    };
    bench.blocks()?;
    bench.scene(
        "compression",
        &["bar=data/bodies/bar.vtp"],
        &[
            ("failure force, N", |summary| {
                figure(summary, "failure force")
            }),
            ("bonds broken at 8 mm", broken),
            ("largest piece, of the mass", largest_piece),
        ],
    )?;
    bench.scene(
        "four-point-bending",
        &["sample=data/bodies/sample.vtp"],
        &[
            ("strength, kPa", |summary| {
                1e-3 * figure(summary, "strength")
            }),
            ("bonds broken", broken),
        ],
    )?;
    bench.scene(
        "drop-inclined",
        &[],
        &[
            ("bonds broken", broken),
            ("largest piece, of the mass", largest_piece),
            ("pieces", pieces),
        ],
    )?;
    bench.chute()?;
    bench.table.write(PAGE, "self_contact_table")
}

fn figure(summary: &Value, name: &str) -> f64 {
    let figures = summary["test"]["results"].as_array();
    let found = (figures.into_iter().flatten()).find(|figure| figure["name"] == name);
    found
        .and_then(|figure| figure["value"].as_f64())
        .unwrap_or(f64::NAN)
}

fn broken(summary: &Value) -> f64 {
    summary["broken_bonds"].as_f64().unwrap_or(f64::NAN)
}

fn largest_piece(summary: &Value) -> f64 {
    let fraction = &summary["fragments"]["mass_fraction_of_largest"];
    fraction.as_f64().unwrap_or(f64::NAN)
}

fn pieces(summary: &Value) -> f64 {
    summary["fragments"]["count"].as_f64().unwrap_or(f64::NAN)
}

/// What is read from a summary, and what it is called in the table.
type Reading = (&'static str, fn(&Value) -> f64);

impl Bench {
    /// Options for one of the ways.
    fn options(way: &str, bodies: &[&str]) -> Vec<String> {
        let set = format!("clusters.self_contact={way}");
        let mut options = vec![
            "--threads".to_owned(),
            "1".to_owned(),
            "--set".to_owned(),
            set,
        ];
        for body in bodies {
            options.extend(["--body".to_owned(), (*body).to_owned()]);
        }
        options
    }

    /// Rows for a scene of `data/scenes`, and one for its processor time.
    fn scene(&mut self, name: &str, bodies: &[&str], readings: &[Reading]) -> Result<(), Failed> {
        let mut summaries = Vec::new();
        for way in WAYS {
            let out = self.folder.join(format!("{name}-{way}"));
            summaries.push(run_scene(
                &self.dem_run,
                name,
                &Self::options(way, bodies),
                &out,
            )?);
        }
        for (what, read) in readings {
            let cells = summaries.iter().map(|summary| number(read(summary)));
            self.row(&format!("`{name}.toml`"), what, cells);
        }
        let times = summaries.iter().map(|summary| number(seconds(summary)));
        self.row(&format!("`{name}.toml`"), "processor time, s", times);
        Ok(())
    }

    fn row(&mut self, scene: &str, what: &str, cells: impl Iterator<Item = String>) {
        let head = [scene.to_owned(), what.to_owned()];
        let cells: Vec<String> = head.into_iter().chain(cells).collect();
        self.table.row(&cells);
    }

    /// A block that is pressed by 0.4 mm: whole, cut in two, and slit but for one row of bonds.
    fn blocks(&mut self) -> Result<(), Failed> {
        for (name, joins) in BLOCKS {
            let path = self.folder.join(format!("{name}.toml"));
            std::fs::write(&path, block(joins))?;
            let mut cells = Vec::new();
            for way in WAYS {
                let out = self.folder.join(format!("{name}-{way}"));
                let summary = run_file(&self.dem_run, &path, &Self::options(way, &[]), &out)?;
                cells.push(number(measured(&summary, "force")?));
            }
            self.row(
                &format!("block, {name}"),
                "force at 0.4 mm, N",
                cells.into_iter(),
            );
        }
        Ok(())
    }

    /// The chute, with several seeds, bonded from the start.
    fn chute(&mut self) -> Result<(), Failed> {
        let name = "chute";
        let mut runs: [Vec<(Value, Vec<f64>)>; 2] = Default::default();
        for seed in 0..SEEDS {
            for (way, runs) in WAYS.iter().zip(&mut runs) {
                let out = self.folder.join(format!("{name}-{way}-{seed}"));
                let mut options = Self::options(way, &[]);
                options.extend(["--set".to_owned(), format!("run.seed={seed}")]);
                let summary = run_scene(&self.dem_run, name, &options, &out)?;
                runs.push((summary, masses(&out)?));
            }
        }
        let scene = format!("`{name}.toml`, {SEEDS} seeds");
        let of_all = |read: fn(&Value) -> f64| {
            let cells = runs.iter().map(|runs| {
                let values: Vec<f64> = runs.iter().map(|(summary, _)| read(summary)).collect();
                mean_and_range(&values, "", 0)
            });
            cells.collect::<Vec<_>>()
        };
        let (bonds, times) = (of_all(broken), of_all(seconds));
        let counts = runs.iter().map(|runs| {
            let counts: Vec<f64> = runs.iter().map(|(_, masses)| masses.len() as f64).collect();
            mean_and_range(&counts, "", 0)
        });
        let counts: Vec<String> = counts.collect();
        let [never, always] = [0, 1].map(|way| -> Vec<f64> {
            runs[way]
                .iter()
                .flat_map(|(_, masses)| masses.iter().copied())
                .collect()
        });
        let apart = format!(
            "{:.3} (by chance, in one of twenty cases: {:.3})",
            distance(&never, &always, |_| 1.0),
            by_chance(never.len(), always.len())
        );
        self.row(&scene, "bonds broken", bonds.into_iter());
        self.row(&scene, "fragments discharged", counts.into_iter());
        let cells = ["".to_owned(), apart];
        self.row(&scene, "distance of their masses (KS)", cells.into_iter());
        self.row(&scene, "processor time, s", times.into_iter());
        Ok(())
    }
}

fn masses(out: &Path) -> Result<Vec<f64>, Failed> {
    Ok(masses_kg(Pieces::Left, out)?)
}

fn seconds(summary: &Value) -> f64 {
    summary["processor_s"].as_f64().unwrap_or(f64::NAN)
}

/// Three significant digits, or a whole number.
fn number(value: f64) -> String {
    if value >= 100.0 || value.fract() == 0.0 {
        format!("{value:.0}")
    } else {
        dem_io::units::significant(value, 3)
    }
}

/// Whether two neighbouring spheres are bonded, by their places on the lattice.
type Joins = fn([usize; 3], [usize; 3]) -> bool;

const BLOCKS: [(&str, Joins); 3] = [
    ("whole", |_, _| true),
    ("cut in two", |a, b| !crosses(a, b)),
    ("slit, held by one row of bonds", |a, b| {
        !crosses(a, b) || (a[0] == 0 && b[0] == 0)
    }),
];

/// Whether a bond crosses the middle of the block.
fn crosses(a: [usize; 3], b: [usize; 3]) -> bool {
    let middle = BLOCK[2] / 2;
    a[2].min(b[2]) == middle - 1 && a[2].max(b[2]) == middle
}

/// The scene of a block of touching spheres between two plates, of which the upper comes down.
fn block(joins: Joins) -> String {
    let [nx, ny, nz] = BLOCK;
    let all: Vec<[usize; 3]> = (0..nz)
        .flat_map(|z| (0..nx).flat_map(move |x| (0..ny).map(move |y| [x, y, z])))
        .collect();
    let apart = |a: [usize; 3], b: [usize; 3]| {
        let square = (0..3).map(|k| a[k].abs_diff(b[k]).pow(2));
        square.sum::<usize>()
    };
    let (mut particles, mut bonds) = (String::new(), String::new());
    for (n, &[x, y, z]) in all.iter().enumerate() {
        let [x_m, y_m, z_m] = [x, y, z].map(|k| (2 * k + 1) as f64 * RADIUS_M);
        let _ = write!(particles, "[{x_m:e}, {y_m:e}, {z_m:e}, {RADIUS_M:e}], ");
        for (m, &other) in all.iter().enumerate().skip(n + 1) {
            if apart([x, y, z], other) <= 2 && joins([x, y, z], other) {
                let _ = write!(bonds, "[{n}, {m}], ");
            }
        }
    }
    let law = "{ law = \"linear\", normal_stiffness = \"200 kN/m\", tangential_stiffness_ratio = 0.8, restitution = 0.3, friction = 0.5 }";
    let above_m = 2.0 * RADIUS_M * nz as f64;
    format!(
        "version = 1\n\
         run = {{ end_time = \"4 ms\", local_damping = 0.2 }}\n\
         materials.cake = {{ density = 2000, young_modulus = \"100 MPa\", poisson_ratio = 0.2 }}\n\
         materials.plate = {{ rigid = true }}\n\
         contacts.cake-cake = {law}\n\
         contacts.cake-plate = {law}\n\
         bonds.cake = {{ young_modulus = \"100 MPa\", poisson_ratio = 0.2, damping = {{ damping_ratio = 0.1 }} }}\n\
         bodies.block = {{ material = \"cake\", bonds = \"cake\", particles = [{particles}], bond_list = [{bonds}] }}\n\
         walls.below = {{ plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}, material = \"plate\" }}\n\
         walls.above = {{ plane = {{ point = [0, 0, {above_m:e}], normal = [0, 0, -1] }}, material = \"plate\", velocity = [0, 0, \"-0.1 m/s\"] }}\n\
         measures.force = {{ of = \"above\", quantity = \"force_z\", statistic = \"largest\" }}\n"
    )
}
