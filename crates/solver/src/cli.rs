//! The command line of dem-run: arguments as typed, and what is done with them.

use std::path::PathBuf;

use clap::Parser;
use dem_io::body::{body_summary, read_body};
use dem_io::safe_write::write_standard_output;
use dem_io::{Diagnostic, Result};

/// Reads a body of bonded particles and says what it holds.
#[derive(Debug, Parser)]
#[command(
    version,
    arg_required_else_help = true,
    after_help = "Exit codes: 0 done, 1 failed while running, 2 bad input.\n\
                  Example: dem-pack cake.stl --diameter 2mm..3mm | dem-run --body -"
)]
pub struct Arguments {
    /// The body: .vtp, .data (LAMMPS), .csv, .txt, or - for a .vtp on standard input
    #[arg(value_name = "BODY", required_unless_present = "body")]
    pub file: Option<PathBuf>,
    /// The same as BODY
    #[arg(long, value_name = "BODY", conflicts_with = "file")]
    pub body: Option<PathBuf>,
    /// Say it as JSON
    #[arg(long)]
    pub json: bool,
}

/// Does what was asked for.
///
/// # Errors
/// The body cannot be read, or standard output cannot be written to. A reader that closes standard output early is no error.
pub fn run(arguments: &Arguments) -> Result<()> {
    let path = arguments.body.as_ref().or(arguments.file.as_ref());
    let path = path.ok_or_else(|| {
        Diagnostic::input(
            "",
            "no body was given",
            "name a file, or - for standard input",
        )
    })?;
    let summary = body_summary(&read_body(path)?);
    write_standard_output(|out| {
        if arguments.json {
            serde_json::to_writer_pretty(&mut *out, &summary)?;
            writeln!(out)
        } else {
            write!(out, "{summary}")
        }
    })
}
