//! `dem-run import`: what LAMMPS computed from an exported scene, as results of a run.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use dem_io::Result;
use dem_io::colour::{Colour, on_standard_error};
use dem_io::standard_output::write_standard_output;
use dem_io::text::{counted, visible};
use dem_results::Existing;

use crate::lammps::import::import as import_run;

#[derive(Debug, Args)]
pub(super) struct ImportArguments {
    /// The folder that dem-run export lammps wrote, with the dumps of the run
    folder: PathBuf,
    /// Folder for the results
    #[arg(long, short, value_name = "FOLDER")]
    output: PathBuf,
    /// Overwrite the results in the folder
    #[arg(long)]
    force: bool,
    /// Only print errors
    #[arg(long, short)]
    quiet: bool,
}

/// Reads the dumps and writes frames and page.
///
/// # Errors
/// Bad or missing files, or a folder that cannot be written to.
pub(super) fn import(arguments: &ImportArguments) -> Result<()> {
    let existing = if arguments.force {
        Existing::Replace
    } else {
        Existing::Refuse
    };
    let came = import_run(&arguments.folder, &arguments.output, existing)?;
    if arguments.quiet {
        return Ok(());
    }
    if let Some(warning) = came.warning() {
        let word = on_standard_error("warning:", Colour::Yellow);
        // A closed output is not a reason to fail: the results are written.
        let _ = writeln!(std::io::stderr(), "{word} {warning}");
    }
    write_standard_output(|out| {
        let (frames, last_s) = (counted(came.frames, "frame"), came.last_s);
        let results = arguments.output.display().to_string();
        writeln!(
            out,
            "{frames}, the last at {last_s} s -> {}",
            visible(&results)
        )
    })
}
