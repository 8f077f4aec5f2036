//! `dem-run import`: what LAMMPS computed from an exported scene, as results of a run.

use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use dem_io::Result;
use dem_io::text::{counted, visible};
use dem_io::whole_folder::WholeFolder;
use dem_results::Existing;
use dem_terminal::colour::{Colour, on_standard_error};
use dem_terminal::standard_output::write_standard_output;

use dem_lammps::import::{Came, import as import_run};

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

/// Imports into a new folder under a temporary name first, so that it appears whole; an existing
/// one is filled where it is.
fn import_whole(arguments: &ImportArguments, existing: Existing) -> Result<Came> {
    let output = &arguments.output;
    if std::fs::symlink_metadata(output).is_ok() || output.file_name().is_none() {
        return import_run(&arguments.folder, output, existing);
    }
    let folder = WholeFolder::beside(output, "--output")?;
    let came = import_run(&arguments.folder, folder.path(), existing)?;
    folder.publish()?;
    Ok(came)
}

/// Reads the dumps and writes frames and page.
pub(super) fn import(arguments: &ImportArguments) -> Result<()> {
    let existing = if arguments.force {
        Existing::Replace
    } else {
        Existing::Refuse
    };
    let came = import_whole(arguments, existing)?;
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
        let broken = counted(came.broken as usize, "broken bond");
        let fragments = counted(came.fragments, "fragment");
        let results = arguments.output.display().to_string();
        writeln!(
            out,
            "{frames}, the last at {last_s} s, {broken}, {fragments} -> {}",
            visible(&results)
        )
    })
}
