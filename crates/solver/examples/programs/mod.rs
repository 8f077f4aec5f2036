//! The two programs, for examples that run them.
#![allow(dead_code, reason = "each example uses a part")]

pub(crate) mod study;

use std::error::Error;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

pub(crate) type Failed = Box<dyn Error>;

/// The programs, compiled for release.
pub(crate) struct Programs {
    pub(crate) dem_pack: PathBuf,
    pub(crate) dem_run: PathBuf,
}

/// The folder of the clone.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The target folder: this example stands three folders below it.
fn target() -> Result<PathBuf, Failed> {
    let own = std::env::current_exe()?;
    Ok(own.ancestors().nth(3).ok_or("no target folder")?.to_owned())
}

/// A folder for results, made if it is missing.
pub(crate) fn results(name: &str) -> Result<PathBuf, Failed> {
    let results = target()?.join(name);
    std::fs::create_dir_all(&results)?;
    Ok(results)
}

impl Programs {
    /// Builds them.
    pub(crate) fn build() -> Result<Self, Failed> {
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
        })
    }
}

/// Prints a command and runs it in the folder of the clone. Returns its standard output.
pub(crate) fn output(command: &mut Command) -> Result<Vec<u8>, Failed> {
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
