//! dem-run from the user's side: scenes and options as input; results, messages and exit codes as
//! output.

mod adaptive;
mod after_run;
mod as_run;
mod bad_bodies;
mod bad_input;
mod body_information;
mod browser;
mod bulk;
mod calibrate;
mod calibrate_several;
mod check;
mod command_line;
mod corpus;
mod damage;
mod discharge;
mod disk;
mod dynamic;
mod dynamic_tests;
mod ends;
mod few_steps;
mod histories;
mod inputs;
mod interrupted;
mod kills;
mod lab;
mod lab_pressures;
pub(crate) mod laboratory;
mod lammps;
mod masses;
mod names;
mod new;
mod pictures;
mod pressing;
mod random;
mod results;
mod resume;
mod round_robin;
mod scenes;
mod size_correction;
mod sound;
mod statics;
mod stress;
mod sweep;
mod threads;
mod unstable;
mod verdict;
mod wall_files;
mod wall_frames;
mod wall_loads;
mod zones;

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use clap::Parser;
use dem_io::Body;
use dem_io::body::{About, vtp};
use dem_pack::cli::Arguments;
use dem_testing::names_in;
use serde_json::Value;
use tempfile::TempDir;

/// The last frame of the results in a folder.
fn last_frame(results: &Path) -> PathBuf {
    let names = names_in(&results.join("frames"));
    let mut frames = names.iter().rev();
    let last = frames.find(|name| name.starts_with("frame_")).unwrap();
    results.join("frames").join(last)
}

fn dem_run() -> Command {
    Command::new(env!("CARGO_BIN_EXE_dem-run"))
}

/// Packs a shape like dem-pack, in this process.
fn dem_pack(stl: &Path, options: &[&str], output: &Path) {
    let mut arguments = vec![OsStr::new("dem-pack"), stl.as_os_str()];
    arguments.extend(options.iter().map(OsStr::new));
    arguments.extend(["--quiet", "-o"].map(OsStr::new));
    arguments.push(output.as_os_str());
    let arguments = Arguments::try_parse_from(arguments).unwrap();
    dem_pack::cli::run(&arguments).unwrap_or_else(|error| panic!("{}: {error}", stl.display()));
}

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A scene of data/scenes.
fn scene_of_data(name: &str) -> PathBuf {
    root().join("data/scenes").join(name)
}

/// The scenes of a folder in tests/scenes, sorted.
fn corpus(folder: &str) -> Vec<PathBuf> {
    let folder = root().join("tests/scenes").join(folder);
    let mut scenes: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    scenes.sort();
    scenes
}

/// A good scene of the corpus.
fn good(name: &str) -> PathBuf {
    root().join("tests/scenes/good").join(name)
}

/// A folder that is removed after the test.
pub(crate) struct Bench {
    folder: TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        fs::write(self.path(name), contents).unwrap();
        self.path(name)
    }

    /// Names of the entries of the folder, including hidden ones.
    fn files(&self) -> Vec<String> {
        names_in(self.folder.path())
    }

    /// The command dem-run SCENE OPTIONS in the folder.
    fn command(&self, scene: &Path, options: &[&str]) -> Command {
        let mut command = dem_run();
        command
            .current_dir(self.folder.path())
            .arg(scene)
            .args(options);
        command
    }

    /// Runs dem-run SCENE OPTIONS in the folder to its end.
    fn run(&self, scene: &Path, options: &[&str]) -> Output {
        self.command(scene, options).output().unwrap()
    }

    /// Runs a valid scene. Returns its messages.
    pub(crate) fn good(&self, scene: &Path, options: &[&str]) -> String {
        let output = self.run(scene, options);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{}: {said}", scene.display());
        assert_eq!(without_warnings(&said), "", "{}", scene.display());
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a scene that fails with this exit code. Returns its only message.
    fn bad(&self, scene: &Path, options: &[&str], code: i32) -> String {
        let (said, found) = refused(&self.run(scene, options));
        assert_eq!(found, code, "{said}");
        said
    }
}

/// All files of a results folder by their names, without the parts of the summary that depend on
/// time and place.
fn results(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for part in ["", "frames", "pictures", "plots"] {
        if !folder.join(part).is_dir() {
            continue;
        }
        for entry in fs::read_dir(folder.join(part)).unwrap() {
            let path = entry.unwrap().path();
            // It contains the summary, including run times.
            if path.is_file() && !path.ends_with(".ended.json") {
                let name = path.strip_prefix(folder).unwrap().display().to_string();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    if let Some(summary) = found.get_mut("summary.json") {
        let mut value: Value = serde_json::from_slice(summary).unwrap();
        for of_time in [
            "resumed_at_s",
            "wall_s",
            "processor_s",
            "threads",
            "steps_per_s",
            "bond_steps_per_s",
            "time_by_stage",
            // Of what followed the last start.
            "part_error",
            "results",
        ] {
            value.as_object_mut().unwrap().remove(of_time);
        }
        *summary = serde_json::to_vec_pretty(&value).unwrap();
    }
    if let Some(page) = found.get_mut("report.html") {
        // The rest of the page holds the times of the summary.
        let text = String::from_utf8(std::mem::take(page)).unwrap();
        let view = text.split("id=\"view-head\"").nth(1).unwrap_or_default();
        *page = view.split("<h2>").next().unwrap().into();
    }
    found
}

/// Asserts that two results folders contain the same bits.
fn assert_same(one: &Path, other: &Path) {
    let (one, other) = (results(one), results(other));
    let names = |of: &BTreeMap<String, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for (name, bytes) in &one {
        let place = bytes.iter().zip(&other[name]).position(|(a, b)| a != b);
        assert!(
            *bytes == other[name],
            "{name} differs at byte {place:?} of {}",
            bytes.len()
        );
    }
}

/// A table with a header, as texts.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<String>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut rows = text
        .lines()
        .map(|line| line.split(',').map(str::to_owned).collect::<Vec<String>>());
    (rows.next().unwrap(), rows.collect())
}

/// A column of a table, as numbers.
fn numbers(path: &Path, column: &str) -> Vec<f64> {
    let (columns, rows) = table(path);
    let at = columns.iter().position(|name| name == column);
    let at = at.unwrap_or_else(|| panic!("no column {column} among {columns:?}"));
    rows.iter().map(|row| row[at].parse().unwrap()).collect()
}

/// A row of particles, each bonded to the next except for one gap.
fn row(particles: usize) -> Body {
    let bonds: Vec<[u32; 2]> = (1..particles as u32)
        .filter(|b| *b as usize != particles / 2)
        .map(|b| [b - 1, b])
        .collect();
    Body {
        positions: (0..particles)
            .map(|i| [i as f64 * 2e-3, 0.0, 0.0])
            .collect(),
        radii: vec![1e-3; particles],
        bond_radii: vec![5e-4; bonds.len()],
        bond_lengths: vec![2e-3; bonds.len()],
        bond_damages: Vec::new(),
        turns_rad: Vec::new(),
        bond_directions: Vec::new(),
        bond_histories: Vec::new(),
        bonds,
        about: About {
            particle_density_kg_m3: Some(2050.0),
            seed: Some(7),
            ..About::default()
        },
    }
}

fn vtp_bytes(body: &Body) -> Vec<u8> {
    let mut bytes = Vec::new();
    vtp::write(body, &mut bytes).unwrap();
    bytes
}

/// Runs dem-run with `input` on its standard input.
fn piped(arguments: &[&str], input: &[u8]) -> Output {
    dem_testing::piped(dem_run().args(arguments), input)
}

/// Standard error without the warnings at the start of a run, which can be doubtful and still end
/// well: `verdict.rs` tests those.
fn without_warnings(said: &str) -> String {
    let is_said = |line: &&str| !line.starts_with("warning: ") && !line.starts_with("note: ");
    let lines = said.lines().filter(is_said);
    lines.map(|line| format!("{line}\n")).collect()
}

/// The only line printed by a failed run, and its exit code.
fn refused(output: &Output) -> (String, i32) {
    let said = without_warnings(&String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty(), "{said}");
    assert_eq!(said.matches('\n').count(), 1, "{said}");
    assert!(said.starts_with("error: "), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    (said.trim_end().to_owned(), output.status.code().unwrap())
}
