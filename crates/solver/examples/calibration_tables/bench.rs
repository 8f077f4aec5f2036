//! The two programs, and their results.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use super::programs::{self, Failed, Programs, output};

pub(crate) struct Bench {
    pub(crate) programs: Programs,
    pub(crate) results: PathBuf,
}

impl Bench {
    /// Builds the programs.
    pub(crate) fn new() -> Result<Self, Failed> {
        Ok(Self {
            programs: Programs::build()?,
            results: programs::results("calibration-tables")?,
        })
    }

    /// A packing of a shape as in the comments of the scenes: overlap 0.296, touching spheres
    /// bonded.
    pub(crate) fn pack(&self, shape: &str, diameters: &str, seed: u32) -> Result<PathBuf, Failed> {
        let body = self.results.join(format!("{shape}.vtp"));
        let mut command = Command::new(&self.programs.dem_pack);
        command.arg(format!("data/shapes/{shape}.stl"));
        command.args(["--diameter", diameters, "--overlap", "0.296"]);
        command.args(["--bond-range", "1.0", "--quiet", "--seed"]);
        output(command.arg(seed.to_string()).arg("-o").arg(&body))?;
        Ok(body)
    }

    /// The summary of the test of a scene in `data/scenes` with these settings.
    pub(crate) fn run(&self, scene: &str, body: &Path, sets: &[&str]) -> Result<Value, Failed> {
        let mut command = Command::new(&self.programs.dem_run);
        command.arg(format!("data/scenes/{scene}.toml"));
        command.args(["--threads", "1", "--quiet", "--json", "--force", "--output"]);
        command.arg(self.results.join("run"));
        command.arg("--body").arg(body);
        for set in sets {
            command.args(["--set", set]);
        }
        Ok(serde_json::from_slice(&output(&mut command)?)?)
    }

    /// The result of this name; `compute` makes it unless it is there.
    pub(crate) fn kept(
        &self,
        name: &str,
        compute: impl FnOnce() -> Result<Value, Failed>,
    ) -> Result<Value, Failed> {
        let file = self.results.join(format!("{name}.json"));
        if file.exists() {
            return Ok(serde_json::from_slice(&std::fs::read(file)?)?);
        }
        let result = compute()?;
        std::fs::write(file, serde_json::to_vec(&result)?)?;
        Ok(result)
    }
}

/// A result of the test of a summary.
pub(crate) fn result(summary: &Value, name: &str) -> Result<f64, Failed> {
    let all = summary["test"]["results"].as_array();
    let found = all.and_then(|all| all.iter().find(|result| result["name"] == name));
    let value = found.and_then(|result| result["value"].as_f64());
    value.ok_or_else(|| format!("the test has no {name}").into())
}

/// A number of a summary.
pub(crate) fn number(summary: &Value, name: &str) -> Result<f64, Failed> {
    let value = summary[name].as_f64();
    value.ok_or_else(|| format!("the summary has no {name}").into())
}
