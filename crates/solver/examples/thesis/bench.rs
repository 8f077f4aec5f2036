//! The two programs, and the folder of the results.

use std::error::Error;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use dem_scene::{Scene, read_scene};
use serde_json::Value;

use super::samples::Sample;

pub(crate) type Failed = Box<dyn Error>;

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// `target/release/examples/thesis` stands three folders below the target folder.
fn target() -> Result<PathBuf, Failed> {
    let own = std::env::current_exe()?;
    Ok(own.ancestors().nth(3).ok_or("no target folder")?.to_owned())
}

/// The folder of the results.
pub(crate) fn results() -> Result<PathBuf, Failed> {
    let results = target()?.join("thesis");
    std::fs::create_dir_all(&results)?;
    Ok(results)
}

/// A result, if it has been computed.
pub(crate) fn read(file: &Path) -> Option<Value> {
    serde_json::from_slice(&std::fs::read(file).ok()?).ok()
}

/// The scene of this name in `data/thesis`.
pub(crate) fn scene_file(name: &str) -> PathBuf {
    root().join(format!("data/thesis/{name}.toml"))
}

pub(crate) struct Bench {
    dem_pack: PathBuf,
    dem_run: PathBuf,
    pub(crate) results: PathBuf,
}

impl Bench {
    /// Builds the programs.
    pub(crate) fn new() -> Result<Self, Failed> {
        let target = target()?;
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut build = Command::new(cargo);
        build.args(["build", "--release", "--quiet", "--bins"]);
        build.args(["-p", "dem-pack", "-p", "dem-run", "--target-dir"]);
        if !build.arg(&target).current_dir(root()).status()?.success() {
            return Err("the programs cannot be built".into());
        }
        let program = |name: &str| {
            let file = target.join("release").join(name);
            file.with_extension(std::env::consts::EXE_EXTENSION)
        };
        Ok(Self {
            dem_pack: program("dem-pack"),
            dem_run: program("dem-run"),
            results: results()?,
        })
    }

    /// The file of a packed sample; its report stands next to it, as JSON.
    pub(crate) fn pack(&self, sample: &Sample) -> Result<PathBuf, Failed> {
        let body = self.results.join(format!("{}.vtp", sample.name()));
        let report = body.with_extension("json");
        if !report.exists() {
            let mut command = Command::new(&self.dem_pack);
            command.args(sample.options()).args(["--json", "-o"]);
            let said = output(command.arg(&body))?;
            std::fs::write(report, said)?;
        }
        Ok(body)
    }

    /// Runs the four-point test of `data/thesis` with these settings, if that has not been done.
    pub(crate) fn bend(&self, name: &str, body: &Path, sets: &[String]) -> Result<(), Failed> {
        let folder = self.results.join(name);
        if finished(&folder).is_some() {
            return Ok(());
        }
        let mut command = Command::new(&self.dem_run);
        command.arg("data/thesis/four-point-bending.toml");
        command.args(["--threads", "1", "--quiet", "--force", "--output"]);
        command.arg(folder).arg("--body").arg(body);
        for set in sets {
            command.args(["--set", set]);
        }
        output(&mut command).map(|_| ())
    }
}

/// The summary of a run that came to its end.
pub(crate) fn finished(folder: &Path) -> Option<Value> {
    let summary = read(&folder.join("summary.json"))?;
    summary.get("problem").is_none().then_some(summary)
}

/// A scene of `data/thesis` with these settings, and this sample if it has one.
pub(crate) fn scene(name: &str, body: Option<&Path>, sets: &[String]) -> Result<Scene, Failed> {
    let mut all: Vec<String> = sets.to_vec();
    if let Some(body) = body {
        all.push(format!(
            "bodies.sample.file={:?}",
            body.display().to_string()
        ));
    }
    Ok(read_scene(&scene_file(name), &all)?)
}

/// Prints a command and runs it in the folder of the clone. Returns its standard output.
fn output(command: &mut Command) -> Result<Vec<u8>, Failed> {
    let words: Vec<_> = command.get_args().map(OsStr::to_string_lossy).collect();
    let program = Path::new(command.get_program())
        .file_name()
        .unwrap_or_default();
    eprintln!("{} {}", program.to_string_lossy(), words.join(" "));
    let done = command.current_dir(root()).output()?;
    if !done.status.success() {
        return Err(String::from_utf8_lossy(&done.stderr).into());
    }
    Ok(done.stdout)
}
