//! Runs scenes and packs bodies and prints a hash of the resulting numbers: two versions of the
//! programs give the same results to the last bit if they print the same lines.
//!
//! ```sh
//! cargo build --release --bins
//! cargo run --release -p dem-tests --example same_bits > before.txt
//! # change something
//! cargo build --release --bins
//! cargo run --release -p dem-tests --example same_bits | diff before.txt -
//! ```
//!
//! The hash covers the numbers of the time series, the events, the fragments and the summary, and
//! of the particles and bonds of a packed body, in their order: names and sentences may change.
//! Values that differ from run to run (times, speeds, the machine) are excluded. Another processor
//! or system may give other numbers. A word after `--` runs only the cases whose name contains it.
#![allow(clippy::print_stdout, reason = "it prints a table")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Scenes of data/scenes, and their settings.
const SCENES: [(&str, &[&str]); 14] = [
    ("cantilever", &["run.end_time=\"0.1 s\""]),
    ("chute", &["run.end_time=\"0.9 s\""]),
    ("chute-region", &["run.end_time=\"0.5 s\""]),
    ("chute-bonded", &["run.end_time=\"0.3 s\""]),
    ("clamped", &[SAMPLE]),
    ("clamped", &[SAMPLE, "run.adaptive=true"]),
    ("drop-flat", &["run.end_time=\"20 ms\""]),
    ("drop-inclined", &["run.end_time=\"10 ms\""]),
    ("jaw-crusher", &["run.end_time=\"0.1 s\""]),
    ("one-cake", &["run.end_time=\"0.06 s\""]),
    ("shatter", &["run.end_time=\"10 ms\""]),
    ("spinning-bar", &["run.end_time=\"20 ms\""]),
    ("three-point-bending", &[SAMPLE]),
    ("four-point-bending", &[SAMPLE, "test.rate_check=false"]),
];

/// Setting for the scenes whose sample is packed first.
const SAMPLE: &str = "bodies.sample.file=\"data/bodies/sample.vtp\"";

/// Shapes of data/shapes, and their packing options.
const PACKINGS: [(&str, &[&str]); 5] = [
    ("tablet", &["--diameter", "1mm..1.4mm"]),
    (
        "bar",
        &[
            "--diameter",
            "2mm..3mm",
            "--overlap",
            "0.296",
            "--bond-range",
            "1.0",
        ],
    ),
    ("disc", &["--diameter", "3mm..4mm", "--densify", "0"]),
    ("bending-sample", &["--diameter", "5mm..7mm", "--seed", "3"]),
    (
        "rock",
        &["--diameter", "4mm..6mm", "--bonds-per-particle", "4"],
    ),
];

/// Keys of a summary whose values differ from run to run or name files.
const VARIES: [&str; 12] = [
    "wall_s",
    "processor_s",
    "threads",
    "machine",
    "steps_per_s",
    "bond_steps_per_s",
    "time_by_stage",
    "inputs",
    "results",
    "scene",
    "program",
    "bodies",
];

type Failed = Box<dyn Error>;

fn main() -> Result<(), Failed> {
    let word = std::env::args().nth(1).unwrap_or_default();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = tempfile::tempdir()?;
    let mut scenes: Vec<(PathBuf, &[&str])> = Vec::new();
    for (name, sets) in SCENES {
        scenes.push((root.join(format!("data/scenes/{name}.toml")), sets));
    }
    for corpus in ["good", "doubtful"] {
        let mut files: Vec<PathBuf> = std::fs::read_dir(root.join("tests/scenes").join(corpus))?
            .map(|entry| entry.map(|entry| entry.path()))
            .collect::<Result<_, _>>()?;
        files.retain(|file| file.extension().is_some_and(|ending| ending == "toml"));
        files.sort();
        scenes.extend(files.into_iter().map(|file| (file, &[][..])));
    }
    for (at, (scene, sets)) in scenes.iter().enumerate() {
        let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
        let name = [&[&*stem], *sets].concat().join(" ");
        if name.contains(&word) {
            let results = folder.path().join(at.to_string());
            let hash = run(scene, sets, &results, 1 + at % 2)?;
            println!("{hash:016x}  {name}");
        }
    }
    for (shape, options) in PACKINGS {
        let name = [&[shape], options].concat().join(" ");
        if name.contains(&word) {
            let stl = root.join(format!("data/shapes/{shape}.stl"));
            println!("{:016x}  {name}", pack(&stl, options, folder.path())?);
        }
    }
    Ok(())
}

/// The hash of the results of a scene.
fn run(scene: &Path, sets: &[&str], results: &Path, threads: usize) -> Result<u64, Failed> {
    let mut command = program("dem-run")?;
    command.arg(scene).arg("--output").arg(results);
    command.args(["--quiet", "--json", "--threads", &threads.to_string()]);
    command.args(sets.iter().flat_map(|set| ["--set", set]));
    command.args(["--set", "output.pictures=\"1000 s\""]);
    let output = command.output()?;
    let mut hash = Hash::new();
    hash.text(&format!("exit code {:?}", output.status.code()));
    for file in ["series.csv", "events.csv", "fragments.csv"] {
        hash.text(&std::fs::read_to_string(results.join(file)).unwrap_or_default());
    }
    match std::fs::read(results.join("summary.json")) {
        Ok(summary) => hash.json(&serde_json::from_slice(&summary)?),
        Err(_) => hash.text(&String::from_utf8_lossy(&output.stderr)),
    }
    Ok(hash.0)
}

/// The hash of the particles and bonds of a packing.
fn pack(stl: &Path, options: &[&str], folder: &Path) -> Result<u64, Failed> {
    let body = folder.join("body.csv");
    let mut command = program("dem-pack")?;
    command.arg(stl).args(options).args(["--quiet"]);
    let output = command.arg("-o").arg(&body).output()?;
    let mut hash = Hash::new();
    hash.text(&format!("exit code {:?}", output.status.code()));
    for file in ["body.csv", "body.particles.csv", "body.bonds.csv"] {
        hash.text(&std::fs::read_to_string(folder.join(file)).unwrap_or_default());
    }
    Ok(hash.0)
}

/// A program built in the same target folder as this one.
fn program(name: &str) -> Result<Command, Failed> {
    let own = std::env::current_exe()?;
    // target/release/examples/same_bits
    let built = own.ancestors().nth(2).ok_or("no target folder")?;
    let mut command = Command::new(built.join(name));
    command.current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."));
    Ok(command)
}

/// FNV-1a over numbers.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn word(&mut self, word: &str) {
        for byte in word.bytes().chain([b' ']) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Adds the words that are numbers.
    fn text(&mut self, text: &str) {
        let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
        for word in words.filter(|word| word.parse::<f64>().is_ok()) {
            self.word(word);
        }
    }

    fn json(&mut self, value: &Value) {
        match value {
            Value::Number(number) => self.word(&number.to_string()),
            Value::Array(items) => items.iter().for_each(|item| self.json(item)),
            Value::Object(entries) => {
                let kept = entries
                    .iter()
                    .filter(|(key, _)| !VARIES.contains(&key.as_str()));
                kept.for_each(|(_, value)| self.json(value));
            }
            _ => {}
        }
    }
}
