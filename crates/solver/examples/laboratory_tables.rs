//! The tables of doc/laboratory.md, made by running the tests and scenes concerned. From the folder
//! of the clone:
//!
//! ```sh
//! cargo run --release -p dem-run --example laboratory_tables -- bending            # 16 minutes
//! cargo run --release -p dem-run --example laboratory_tables -- disc-and-bar
//! cargo run --release -p dem-run --example laboratory_tables -- larger-spheres     # 4 minutes
//! cargo run --release -p dem-run --example laboratory_tables -- drops
//! ```
//!
//! Builds both programs, packs the bodies and runs the scenes unchanged except for the `--set`s
//! printed on standard error, one after another on one thread. Times are those of one core that
//! does nothing else. A number after the word gives the number of packings (4 unless given).
//! Results are written to `target/laboratory-tables`; `--resume` at the end keeps the complete
//! ones.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "it prints a table, and how far it is"
)]

mod programs;

use std::path::{Path, PathBuf};
use std::process::Command;

use dem_io::units::significant;
use dem_scene::study::read_study;
use serde_json::Value;

use programs::{Failed, Programs, output, root};

/// Number of packings for a mean and its scatter, unless given: `--seed 1` to `--seed 4`.
const PACKINGS: u32 = 4;
/// The packing used where a single one is enough.
const FIRST: u32 = 1;
const LARGER_SPHERES: &str = "data/studies/larger-spheres.toml";
/// Impact speed of the samples, m/s, in the scenes of drops.
const IMPACT_SPEED_M_S: f64 = 4.0;
const GRAVITY_M_S2: f64 = 9.81;
const NO_RATE_CHECK: &str = "test.rate_check=false";
/// Hardly any pictures, as they take time.
const PICTURES: &str = "output.pictures=\"1 s\"";

/// A table of the page: its command word, its header, and the first cell of each row.
struct Table {
    words: String,
    head: &'static [&'static str],
    first_cells: Vec<String>,
}

/// The four-point test, a row for each packing. The rate is checked for the first only, as that
/// takes half as long again.
const BENDING_HEAD: [&str; 8] = [
    "packing",
    "bonds",
    "E by eq. 18",
    "specimen modulus over bond modulus",
    "failure force",
    "half the rate changes E, force",
    "crack from the middle",
    "broken bonds between the pins",
];

const DISC_AND_BAR_HEAD: [&str; 7] = [
    "scene",
    "bonds",
    "failure force",
    "strength",
    "specimen modulus",
    "half the rate changes the force",
    "crack from the middle",
];

const DISC_AND_BAR: [(&str, &str); 3] = [
    ("brazilian-disc", "disc"),
    ("compression", "bar"),
    ("tension", "bar"),
];

const LARGER_SPHERES_HEAD: [&str; 9] = [
    "spheres",
    "bonds",
    "bonds' modulus, strength",
    "stiffness",
    "failure force",
    "curve apart",
    "steps",
    "processor time",
    "times as fast",
];

const FLAT_HEAD: [&str; 3] = [
    "`bonds.cake.damping.damping_ratio`",
    "rebound",
    "fraction of the height of the fall",
];

const DAMPING: [&str; 4] = ["0.02", "0.1", "0.2", "0.5"];

const INCLINED_HEAD: [&str; 5] = [
    "strength of bonds",
    "15 degrees, flat",
    "15 degrees, upright",
    "25 degrees, flat",
    "25 degrees, upright",
];

/// Dependence of the strength of the bonds on the rate. The unchanged scene is run with all
/// packings, the others with the first.
struct Strength {
    first_cell: &'static str,
    /// Name for folders.
    name: &'static str,
    sets: &'static [&'static str],
    all_packings: bool,
}

const STRENGTHS: [Strength; 3] = [
    Strength {
        first_cell: "rises with the rate of eq. 21 (the scene)",
        name: "eq-21",
        sets: &[],
        all_packings: true,
    },
    Strength {
        first_cell: "rises with the rate of elongation, `--seed 1`",
        name: "elongation",
        sets: &["bonds.cake.failure.strain_rate_measure=\"elongation\""],
        all_packings: false,
    },
    Strength {
        first_cell: "does not rise, `--seed 1`",
        name: "steady",
        sets: &["bonds.cake.failure.rate_strengthening=false"],
        all_packings: false,
    },
];

/// The columns of the inclined drops.
const FALLS: [(&str, &[&str]); 4] = [
    ("15-flat", &[]),
    ("15-upright", &UPRIGHT),
    ("25-flat", &[TILT]),
    ("25-upright", &[TILT, UPRIGHT[0], UPRIGHT[1]]),
];
const TILT: &str = "walls.plate.rotation.angle=\"25 deg\"";
const UPRIGHT: [&str; 2] = [
    "bodies.sample.rotation={axis=[0,1,0],angle=\"-90 deg\"}",
    "bodies.sample.position=[\"17.5 mm\",\"-15 mm\",\"15 mm\"]",
];

fn main() -> Result<(), Failed> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let resume = words.last().is_some_and(|word| word == "--resume");
    words.truncate(words.len() - usize::from(resume));
    let word = words.first().map_or("", String::as_str);
    let packings = match &words[..] {
        [_, number] => number.parse().ok().filter(|number| *number > 0),
        words => (words.len() == 1).then_some(PACKINGS),
    };
    let work: fn(&Bench, u32) -> Result<(), Failed> = match word {
        "bending" => bending,
        "disc-and-bar" => disc_and_bar,
        "larger-spheres" => larger_spheres,
        "drops" => drops,
        _ => |_, _| Err(USAGE.into()),
    };
    let packings = packings.ok_or(USAGE)?;
    work(&Bench::new(resume)?, packings)
}

const USAGE: &str = "write bending, disc-and-bar, larger-spheres or drops, then a number of packings or nothing, then --resume or nothing";

/// The word of a table, and the number of packings if it is not the default.
fn words(word: &str, packings: u32) -> String {
    if packings == PACKINGS {
        word.to_owned()
    } else {
        format!("{word} {packings}")
    }
}

fn bending_table(packings: u32) -> Table {
    let mut first_cells: Vec<String> = (FIRST..=packings)
        .map(|seed| format!("`--seed {seed}`"))
        .collect();
    if packings > 1 {
        first_cells.push("mean +- scatter".to_owned());
    }
    Table {
        words: words("bending", packings),
        head: &BENDING_HEAD,
        first_cells,
    }
}

/// Settings of the four-point test of a packing.
fn bending_sets(seed: u32) -> &'static [&'static str] {
    if seed == FIRST { &[] } else { &[NO_RATE_CHECK] }
}

fn bending(bench: &Bench, packings: u32) -> Result<(), Failed> {
    let mut runs = Vec::new();
    for seed in FIRST..=packings {
        let body = bench.pack("sample", "bending-sample", "2mm..3mm", seed)?;
        let name = format!("four-point-bending-{seed}");
        runs.push(bench.run(&name, "four-point-bending", Some(&body), bending_sets(seed))?);
    }
    let over =
        |value: &dyn Fn(&Value) -> f64| scattered(&runs.iter().map(value).collect::<Vec<_>>());
    let mut rows: Vec<Vec<String>> = runs.iter().map(bending_cells).collect();
    let [modulus, ratio, force] = [
        over(&|run| 1e-6 * figure(run, "modulus without shear")),
        over(&|run| figure(run, "specimen modulus over bond modulus")),
        over(&|run| figure(run, "failure force")),
    ];
    rows.push(vec![
        String::new(),
        format!("{:.2} MPa +- {:.2} MPa", modulus.mean, modulus.scatter),
        format!("{:.2} +- {:.2}", ratio.mean, ratio.scatter),
        format!("{:.1} N +- {:.1} N", force.mean, force.scatter),
        String::new(),
        String::new(),
        String::new(),
    ]);
    bending_table(packings).print(&rows);
    Ok(())
}

fn bending_cells(run: &Value) -> Vec<String> {
    let crack = &run["test"]["crack"];
    let changes = ["modulus without shear", "failure force"].map(|name| {
        let changes = &run["test"]["changes_at_half_the_rate"];
        found(changes, name).map(|change| percent(number(&change["value"])))
    });
    let changes: Vec<String> = changes.into_iter().flatten().collect();
    vec![
        thousands(&run["bonds"]),
        with_error(run, "modulus without shear", 1e-6, 2, "MPa"),
        format!("{:.2}", figure(run, "specimen modulus over bond modulus")),
        with_error(run, "failure force", 1.0, 1, "N"),
        changes.join(", "),
        format!(
            "{:.1} mm +- {:.1} mm",
            1e3 * number(&crack["offset_m"]),
            1e3 * number(&crack["spread_m"])
        ),
        format!("{:.0} %", 100.0 * number(&crack["fraction_within"])),
    ]
}

fn disc_and_bar_table(packings: u32) -> Table {
    Table {
        words: words("disc-and-bar", packings),
        head: &DISC_AND_BAR_HEAD,
        first_cells: DISC_AND_BAR
            .map(|(scene, _)| format!("`{scene}.toml`"))
            .into(),
    }
}

fn disc_and_bar(bench: &Bench, packings: u32) -> Result<(), Failed> {
    let mut rows = Vec::new();
    for (scene, shape) in DISC_AND_BAR {
        let mut runs = Vec::new();
        for seed in FIRST..=packings {
            let body = bench.pack(shape, shape, "2mm..3mm", seed)?;
            runs.push(bench.run(&format!("{scene}-{seed}"), scene, Some(&body), &[])?);
        }
        let over = |digits, factor: f64, unit: &str, value: &dyn Fn(&Value) -> f64| {
            let values: Vec<f64> = runs.iter().map(|run| factor * value(run)).collect();
            in_cell(&values, digits, unit)
        };
        let change = |run: &Value| {
            let changes = &run["test"]["changes_at_half_the_rate"];
            found(changes, "failure force").map_or(f64::NAN, |change| number(&change["value"]))
        };
        rows.push(vec![
            over(0, 1.0, "", &|run| number(&run["bonds"])),
            over(1, 1.0, "N", &|run| figure(run, "failure force")),
            over(4, 1e-6, "MPa", &|run| figure(run, "strength")),
            over(2, 1e-6, "MPa", &|run| figure(run, "specimen modulus")),
            over(1, 100.0, "%", &change),
            over(1, 1e3, "mm", &|run| {
                number(&run["test"]["crack"]["offset_m"])
            }),
        ]);
    }
    disc_and_bar_table(packings).print(&rows);
    Ok(())
}

fn larger_spheres_table() -> Result<Table, Failed> {
    let study = read_study(&root().join(LARGER_SPHERES))?;
    let values = &study.axes[0].values;
    Ok(Table {
        words: "larger-spheres".to_owned(),
        head: &LARGER_SPHERES_HEAD,
        first_cells: values.iter().map(|value| value.label.clone()).collect(),
    })
}

/// The unchanged study, except for the file of the first body.
fn larger_spheres(bench: &Bench, _: u32) -> Result<(), Failed> {
    let body = bench.pack("sample", "bending-sample", "2mm..3mm", FIRST)?;
    let data = root().join("data");
    let text = std::fs::read_to_string(root().join(LARGER_SPHERES))?
        .replace("../../sample.vtp", &body.display().to_string())
        .replace("\"../", &format!("\"{}/", data.display()));
    let study_file = bench.results.join("larger-spheres.toml");
    std::fs::write(&study_file, text)?;
    let folder = bench.results.join("larger-spheres");
    let mut command = Command::new(&bench.programs.dem_run);
    command.arg("sweep").arg(&study_file);
    command.args(["--json", "--quiet", "--output"]).arg(&folder);
    command.arg(if bench.resume && folder.exists() {
        "--resume"
    } else {
        "--force"
    });
    let table: Value = serde_json::from_slice(&output(&mut command)?)?;
    let study = read_study(&study_file)?;
    let measure = |run: &Value, name: &str| {
        let place = study
            .measures
            .iter()
            .position(|measure| measure.name == name);
        place.map_or(Value::Null, |place| run["results"][place].clone())
    };
    let mut rows = Vec::new();
    for (run, value) in list(&table["runs"]).iter().zip(&study.axes[0].values) {
        if let Some(why) = run["failed"].as_str() {
            return Err(why.into());
        }
        let set = |path: &str| {
            let found = value.settings.iter().find(|setting| setting.path == path);
            found.map_or("", |setting| setting.value.trim_matches('"'))
        };
        let summary = folder.join(format!("runs/{:04}-1/summary.json", number(&run["number"])));
        let summary: Value = serde_json::from_slice(&std::fs::read(summary)?)?;
        let [stiffness, force, curve] =
            ["stiffness", "force", "curve"].map(|name| measure(run, name));
        // The error of a study has no sign.
        let against = |judged: &Value| {
            let reference = judged["reference"].as_f64();
            let change = reference.map(|reference| number(&judged["value"]) / reference - 1.0);
            change.map_or_else(String::new, |change| format!(" ({})", percent(change)))
        };
        rows.push(vec![
            thousands(&summary["bonds"]),
            format!(
                "{}, {}",
                set("bonds.cake.young_modulus"),
                set("bonds.cake.failure.von_mises_strength")
            ),
            format!(
                "{:.2} kN/m{}",
                1e-3 * number(&stiffness["value"]),
                against(&stiffness)
            ),
            format!("{:.1} N{}", number(&force["value"]), against(&force)),
            curve["error"]
                .as_f64()
                .map_or_else(String::new, |error| format!("{:.1} %", 100.0 * error)),
            thousands(&run["steps"]),
            format!("{} s", significant(number(&run["time_s"]), 3)),
            curve["times_as_fast"]
                .as_f64()
                .map_or_else(String::new, |times| format!("{times:.0}")),
        ]);
    }
    larger_spheres_table()?.print(&rows);
    eprintln!("the picture: {}", folder.join("curve-curves.svg").display());
    Ok(())
}

fn flat_table(packings: u32) -> Table {
    Table {
        words: words("drops", packings),
        head: &FLAT_HEAD,
        first_cells: DAMPING.map(str::to_owned).into(),
    }
}

fn inclined_table(packings: u32) -> Table {
    Table {
        words: words("drops", packings),
        head: &INCLINED_HEAD,
        first_cells: STRENGTHS
            .map(|strength| strength.first_cell.to_owned())
            .into(),
    }
}

fn damping_set(damping: &str) -> String {
    format!("bonds.cake.damping.damping_ratio={damping}")
}

fn inclined_sets(strength: &[&'static str], fall: &[&'static str]) -> Vec<&'static str> {
    [&[PICTURES], strength, fall].concat()
}

fn drops(bench: &Bench, packings: u32) -> Result<(), Failed> {
    let mut bodies = Vec::new();
    for seed in FIRST..=packings {
        bodies.push(bench.pack("coarse-sample", "bending-sample", "5mm..7mm", seed)?);
    }
    let flat = flat_rows(bench)?;
    let inclined = inclined_rows(bench, &bodies)?;
    flat_table(packings).print(&flat);
    println!();
    inclined_table(packings).print(&inclined);
    Ok(())
}

/// Rebound height of the scene's own body.
fn flat_rows(bench: &Bench) -> Result<Vec<Vec<String>>, Failed> {
    let height_m = IMPACT_SPEED_M_S.powi(2) / (2.0 * GRAVITY_M_S2);
    let mut rows = Vec::new();
    for damping in DAMPING {
        let sets = [PICTURES, &damping_set(damping)];
        let run = bench.run(&format!("drop-flat-{damping}"), "drop-flat", None, &sets)?;
        let rebound_m = measured(&run, "rebound_height");
        rows.push(vec![
            format!("{:.0} mm", 1e3 * rebound_m),
            format!("{:.0} %", 100.0 * rebound_m / height_m),
        ]);
    }
    Ok(rows)
}

/// For each fall, the broken bonds, mean and scatter, and the fraction of the largest piece,
/// smallest to largest.
fn inclined_rows(bench: &Bench, bodies: &[PathBuf]) -> Result<Vec<Vec<String>>, Failed> {
    let mut rows = Vec::new();
    for strength in STRENGTHS {
        let mut cells = Vec::new();
        for (fall, tilt) in FALLS {
            let sets = inclined_sets(strength.sets, tilt);
            let count = if strength.all_packings {
                bodies.len()
            } else {
                1
            };
            let (mut broken, mut largest) = (Vec::new(), Vec::new());
            for (seed, body) in (FIRST..).zip(bodies.iter().take(count)) {
                let name = format!("drop-inclined-{}-{fall}-{seed}", strength.name);
                let run = bench.run(&name, "drop-inclined", Some(body), &sets)?;
                broken.push(measured(&run, "broken_bonds"));
                largest.push(measured(&run, "largest_piece"));
            }
            largest.sort_by(f64::total_cmp);
            let range = match largest[..] {
                [least, .., most] => format!("{least:.3} to {most:.3}"),
                _ => in_cell(&largest, 3, ""),
            };
            cells.push(format!("{}; {range}", in_cell(&broken, 0, "")));
        }
        rows.push(cells);
    }
    Ok(rows)
}

impl Table {
    fn comment(&self) -> String {
        let command = "cargo run --release -p dem-run --example laboratory_tables --";
        format!("<!-- {command} {} -->", self.words)
    }

    fn head_lines(&self) -> [String; 2] {
        let cells: Vec<&str> = self.head.to_vec();
        [
            format!("| {} |", cells.join(" | ")),
            format!("|{}", "---|".repeat(cells.len())),
        ]
    }

    /// The cells of a row after the first are in the order of the header.
    fn print(&self, rows: &[Vec<String>]) {
        println!("{}", self.comment());
        for line in self.head_lines() {
            println!("{line}");
        }
        for (first, cells) in self.first_cells.iter().zip(rows) {
            println!("| {first} | {} |", cells.join(" | "));
        }
    }
}

/// The two programs, and the folder of their results.
struct Bench {
    programs: Programs,
    results: PathBuf,
    resume: bool,
}

impl Bench {
    /// Builds the programs.
    fn new(resume: bool) -> Result<Self, Failed> {
        Ok(Self {
            programs: Programs::build()?,
            results: programs::results("laboratory-tables")?,
            resume,
        })
    }

    /// A packing of a shape as in the scenes' comments: overlap 0.296, touching spheres bonded.
    fn pack(&self, name: &str, shape: &str, sizes: &str, seed: u32) -> Result<PathBuf, Failed> {
        let body = self.results.join(format!("{name}-{seed}.vtp"));
        let mut command = Command::new(&self.programs.dem_pack);
        command.arg(format!("data/shapes/{shape}.stl"));
        command.args(["--diameter", sizes, "--overlap", "0.296"]);
        command.args(["--bond-range", "1.0", "--quiet", "--seed"]);
        command.arg(seed.to_string()).arg("-o").arg(&body);
        if !(self.resume && body.exists()) {
            output(&mut command)?;
        }
        Ok(body)
    }

    /// The summary of a run.
    fn run(
        &self,
        name: &str,
        scene: &str,
        body: Option<&Path>,
        sets: &[&str],
    ) -> Result<Value, Failed> {
        let folder = self.results.join(name);
        let summary = folder.join("summary.json");
        let mut command = Command::new(&self.programs.dem_run);
        command.arg(format!("data/scenes/{scene}.toml"));
        command.args(["--threads", "1", "--quiet", "--force", "--output"]);
        command.arg(&folder);
        if let Some(body) = body {
            command.arg("--body").arg(body);
        }
        for set in sets {
            command.args(["--set", set]);
        }
        if !(self.resume && summary.exists()) {
            output(&mut command)?;
        }
        Ok(serde_json::from_slice(&std::fs::read(summary)?)?)
    }
}

/// Mean and standard deviation over packings.
struct Scattered {
    mean: f64,
    scatter: f64,
}

fn scattered(values: &[f64]) -> Scattered {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Scattered {
        mean,
        scatter: (squares / (count - 1.0)).sqrt(),
    }
}

/// Mean and scatter of the available values, and their number if some are missing. Empty if there
/// are none.
fn in_cell(values: &[f64], digits: usize, unit: &str) -> String {
    let there: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    if there.is_empty() {
        return String::new();
    }
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    };
    let Scattered { mean, scatter } = scattered(&there);
    let mut cell = match there[..] {
        [only] => format!("{only:.digits$}{unit}"),
        _ => format!("{mean:.digits$}{unit} +- {scatter:.digits$}{unit}"),
    };
    if there.len() < values.len() {
        cell += &format!(" ({} of {})", there.len(), values.len());
    }
    cell
}

/// The figure of a test with this name, in any list.
fn figure(run: &Value, name: &str) -> f64 {
    ["results", "calibration"]
        .iter()
        .find_map(|part| found(&run["test"][part], name))
        .map_or(f64::NAN, |figure| number(&figure["value"]))
}

fn with_error(run: &Value, name: &str, factor: f64, digits: usize, unit: &str) -> String {
    let Some(figure) = found(&run["test"]["results"], name) else {
        return String::new();
    };
    let value = factor * number(&figure["value"]);
    format!(
        "{value:.digits$} {unit} ({})",
        percent(number(&figure["error"]))
    )
}

fn measured(run: &Value, name: &str) -> f64 {
    number(&run["measures"][name]["value"])
}

/// The entry of a list with this name.
fn found<'a>(entries: &'a Value, name: &str) -> Option<&'a Value> {
    list(entries).iter().find(|entry| entry["name"] == name)
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn percent(fraction: f64) -> String {
    format!("{:+.1} %", 100.0 * fraction)
}

fn thousands(value: &Value) -> String {
    let digits = value.as_u64().unwrap_or_default().to_string();
    let mut text = String::new();
    for (place, digit) in digits.char_indices() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]

    use dem_scene::read_scene;

    use super::*;

    /// The tables with the numbers of packings given in the page.
    fn tables(packings: &dyn Fn(&str) -> u32) -> [Table; 5] {
        [
            bending_table(packings("bending")),
            disc_and_bar_table(packings("disc-and-bar")),
            larger_spheres_table().unwrap(),
            flat_table(packings("drops")),
            inclined_table(packings("drops")),
        ]
    }

    fn packings_in(page: &str, word: &str) -> u32 {
        let (_, after) = page
            .split_once(&format!("laboratory_tables -- {word} "))
            .unwrap();
        let number = after.split(' ').next().unwrap();
        number.parse().unwrap_or(PACKINGS)
    }

    /// The lines of the page from each comment with a command to the end of its table.
    fn tables_of_page(page: &str) -> Vec<Vec<&str>> {
        let lines: Vec<&str> = page.lines().collect();
        let starts = lines
            .iter()
            .enumerate()
            .filter(|(_, line)| line.starts_with("<!-- cargo"));
        starts
            .map(|(start, _)| {
                let end = lines[start..].iter().position(|line| line.is_empty());
                lines[start..start + end.unwrap_or(lines.len() - start)].to_vec()
            })
            .collect()
    }

    /// Commands, headers and first cells of the page are those that the program prints, and every
    /// row has all of its cells.
    #[test]
    fn the_page_has_the_tables_of_this_program() {
        let page = std::fs::read_to_string(root().join("doc/laboratory.md")).unwrap();
        let of_page = tables_of_page(&page);
        let tables = tables(&|word| packings_in(&page, word));
        assert_eq!(of_page.len(), tables.len());
        for (table, lines) in tables.iter().zip(of_page) {
            assert_eq!(lines[0], table.comment());
            assert_eq!(lines[1..3], table.head_lines());
            let rows: Vec<Vec<&str>> = lines[3..]
                .iter()
                .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
                .collect();
            let first: Vec<&str> = rows.iter().map(|row| row[0]).collect();
            assert_eq!(first, table.first_cells);
            for row in rows {
                assert_eq!(row.len(), table.head.len(), "{row:?}");
            }
        }
    }

    /// The keys set by the rows exist in the scenes.
    #[test]
    fn scenes_take_what_rows_set() {
        let mut asked: Vec<(&str, Vec<String>)> = Vec::new();
        let owned = |sets: &[&str]| sets.iter().map(|set| (*set).to_owned()).collect();
        for seed in FIRST..=PACKINGS {
            asked.push(("four-point-bending", owned(bending_sets(seed))));
        }
        for (scene, _) in DISC_AND_BAR {
            asked.push((scene, Vec::new()));
        }
        for damping in DAMPING {
            asked.push(("drop-flat", vec![PICTURES.to_owned(), damping_set(damping)]));
        }
        for strength in STRENGTHS {
            for (_, fall) in FALLS {
                asked.push(("drop-inclined", owned(&inclined_sets(strength.sets, fall))));
            }
        }
        assert_eq!(asked.len(), 23);
        for (scene, sets) in asked {
            let path = root().join(format!("data/scenes/{scene}.toml"));
            let plain = read_scene(&path, &[]).unwrap();
            let changed =
                read_scene(&path, &sets).unwrap_or_else(|error| panic!("{sets:?}: {error}"));
            assert!(
                sets.is_empty() || plain != changed,
                "{scene}: {sets:?} change nothing"
            );
        }
    }

    #[test]
    fn cells_hold_mean_and_scatter() {
        assert_eq!(in_cell(&[1.0, 3.0], 1, "N"), "2.0 N +- 1.4 N");
        assert_eq!(in_cell(&[1.0, 3.0, f64::NAN], 0, ""), "2 +- 1 (2 of 3)");
        assert_eq!(in_cell(&[f64::NAN], 0, "N"), "");
        assert_eq!(thousands(&1_234_567.into()), "1,234,567");
        assert_eq!(thousands(&999.into()), "999");
        assert_eq!(percent(-0.004), "-0.4 %");
    }
}
