//! `dem-run BODY`: describes a body.

use std::path::PathBuf;

use dem_io::body::{body_summary, read_body};
use dem_io::{Diagnostic, Result};
use dem_terminal::standard_output::{write_standard_json, write_standard_output};

use super::scene_arguments::SceneArguments;

pub(super) fn body_information(arguments: &SceneArguments) -> Result<()> {
    let given = arguments.body.first().map(PathBuf::from);
    let path = arguments.file.as_ref().or(given.as_ref());
    let path = path.ok_or_else(|| {
        Diagnostic::input(
            "",
            "no scene and no body was given",
            "name a scene (.toml) or a body, or - for a body on standard input",
        )
    })?;
    let summary = body_summary(&read_body(path)?);
    if arguments.json {
        return write_standard_json(&summary);
    }
    write_standard_output(|out| write!(out, "{summary}"))
}
