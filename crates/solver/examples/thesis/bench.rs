//! The two programs, and the folder of the results.

use std::path::{Path, PathBuf};
use std::process::Command;

use dem_scene::{Scene, read_scene};
use serde_json::Value;

use super::programs::{self, Programs, output};
pub(crate) use super::programs::{Failed, root};

/// The folder of the results.
pub(crate) fn results() -> Result<PathBuf, Failed> {
    programs::results("thesis")
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
    pub(crate) programs: Programs,
    pub(crate) results: PathBuf,
}

impl Bench {
    /// Builds the programs.
    pub(crate) fn new() -> Result<Self, Failed> {
        Ok(Self {
            programs: Programs::build()?,
            results: results()?,
        })
    }

    /// Runs the four-point test of `data/thesis` with these settings, if that has not been done.
    pub(crate) fn bend(&self, name: &str, body: &Path, sets: &[String]) -> Result<(), Failed> {
        let folder = self.results.join(name);
        if finished(&folder).is_some() {
            return Ok(());
        }
        let mut command = Command::new(&self.programs.dem_run);
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
