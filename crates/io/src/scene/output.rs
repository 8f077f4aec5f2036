//! `[output]`

use std::path::Path;

use super::Output;
use super::field::Field;
use super::read::resolved;
use crate::Result;
use crate::units::TIME;

pub(super) fn read(field: &Field<'_>, folder: &Path) -> Result<Output> {
    let table = field.table(&["folder", "frames", "series", "checkpoint"])?;
    let interval = |key| table.read(key, |field: Field<'_>| field.positive(&TIME));
    Ok(Output {
        folder: table.read("folder", |field| {
            let name = field.text()?;
            if name.trim().is_empty() || name == "-" {
                return Err(field.wrong("the name of a folder", "such as \"results\""));
            }
            Ok(resolved(folder, name))
        })?,
        frames_s: interval("frames")?,
        series_s: interval("series")?,
        checkpoint_s: interval("checkpoint")?,
    })
}
