//! dem-pack from the user's side: shapes and options as input; bodies, reports and messages as
//! output.

mod bad_input;
mod bond;
mod bonds;
mod command_line;
mod density;
mod determinism;
mod files;
mod interrupted;
mod quality;
mod refused_shapes;
mod shapes;
mod sizes;

use super::helpers::exact;
use super::helpers::facets::{self, Facets, Point};
use dem_io::Body;
use dem_io::body::read_body;
use serde_json::Value;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

fn dem_pack() -> Command {
    Command::new(env!("CARGO_BIN_EXE_dem-pack"))
}

/// The root of the repository.
fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A difficult STL file, by the start of its name.
fn shape(name: &str) -> PathBuf {
    let folder = root().join("crates/io/tests/shapes");
    fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .find(|path| {
            path.file_name()
                .unwrap()
                .to_str()
                .unwrap()
                .starts_with(name)
        })
        .unwrap()
}

/// Facets of a binary STL file, without duplicates and those without area.
fn read_stl(path: &Path) -> Facets {
    let bytes = fs::read(path).unwrap();
    let mut seen = std::collections::BTreeSet::new();
    let number = |at: &[u8]| f64::from(f32::from_le_bytes(at.try_into().unwrap()));
    bytes[84..]
        .chunks_exact(50)
        .map(|facet| {
            [0, 1, 2].map(|c| [0, 1, 2].map(|k| number(&facet[12 + 12 * c + 4 * k..][..4])))
        })
        .filter(|[a, b, c]| {
            exact::length(exact::cross(exact::sub(*b, *a), exact::sub(*c, *a))) > 0.0
        })
        .filter(|corners| {
            let mut key = corners.map(|p| p.map(f64::to_bits));
            key.sort_unstable();
            seen.insert(key)
        })
        .collect()
}

/// A folder that is removed after the test, with the files made in it.
struct Bench {
    folder: TempDir,
}

/// A body and its report.
struct Made {
    body: Body,
    report: Value,
    said: String,
}

impl Bench {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes an STL file of these facets.
    fn stl(&self, name: &str, facets: &[[Point; 3]]) -> PathBuf {
        fs::write(self.path(name), facets::stl(facets)).unwrap();
        self.path(name)
    }

    /// Names of the files in the folder, hidden ones too.
    fn files(&self) -> Vec<String> {
        dem_testing::names_in(self.folder.path())
    }

    /// Runs dem-pack STL OPTIONS in the folder.
    fn run(&self, stl: &Path, options: &[&str]) -> Output {
        dem_pack()
            .current_dir(self.folder.path())
            .arg(stl)
            .args(options)
            .output()
            .unwrap()
    }

    /// Packs a shape that can be packed.
    /// The body alone, without its report.
    fn pack_only(&self, stl: &Path, options: &[&str]) -> Body {
        let output = self.run(stl, &[options, &["--quiet", "-o", "body.vtp"]].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{}: {said}", stl.display());
        read_body(&self.path("body.vtp")).unwrap()
    }

    fn pack(&self, stl: &Path, options: &[&str]) -> Made {
        let output = self.run(stl, &[options, &["--json", "-o", "body.vtp"]].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{}: {said}", stl.display());
        let report = serde_json::from_slice(&output.stdout).unwrap();
        Made {
            body: read_body(&self.path("body.vtp")).unwrap(),
            report,
            said,
        }
    }
}

impl Made {
    fn number(&self, pointer: &str) -> f64 {
        self.report
            .pointer(pointer)
            .and_then(Value::as_f64)
            .unwrap_or_else(|| panic!("{pointer} in {}", self.report))
    }

    fn count(&self, pointer: &str) -> u64 {
        self.report
            .pointer(pointer)
            .and_then(Value::as_u64)
            .unwrap_or_else(|| panic!("{pointer} in {}", self.report))
    }

    /// Centres and radii in mm.
    fn millimetres(&self) -> (Vec<Point>, Vec<f64>) {
        (
            self.body
                .positions
                .iter()
                .map(|p| p.map(|x| 1e3 * x))
                .collect(),
            self.body.radii.iter().map(|r| 1e3 * r).collect(),
        )
    }
}

/// Positions and radii as bits.
fn bits(body: &Body) -> (Vec<[u64; 3]>, Vec<u64>) {
    (
        body.positions.iter().map(|p| p.map(f64::to_bits)).collect(),
        body.radii.iter().map(|r| r.to_bits()).collect(),
    )
}

/// The only message of a refused run: exit code 2, nothing on standard output.
fn refusal(output: &Output, what: &dyn AsRef<OsStr>) -> String {
    let what = what.as_ref().display();
    let said = String::from_utf8(output.stderr.clone()).unwrap();
    assert_eq!(output.status.code(), Some(2), "{what}: {said}");
    assert!(
        output.stdout.is_empty(),
        "{what}: {}",
        String::from_utf8_lossy(&output.stdout)
    );
    assert!(
        said.starts_with("error: ") && said.matches("error: ").count() == 1,
        "{what}: {said}"
    );
    assert!(
        !said.contains("panicked") && !said.contains("RUST_BACKTRACE"),
        "{what}: {said}"
    );
    said.trim_end().to_owned()
}
