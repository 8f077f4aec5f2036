//! `[output]`

use std::path::Path;

use super::Output;
use super::field::Field;
use super::read::named_path;
use crate::Result;
use crate::units::TIME;

pub(super) fn read(field: &Field<'_>, folder: &Path) -> Result<Output> {
    let table = field.table(&["folder", "frames", "series", "checkpoint"])?;
    let interval = |key| table.read(key, |field: Field<'_>| field.positive(&TIME));
    Ok(Output {
        folder: table.read("folder", |field| {
            let path = named_path(&field, folder)?;
            if path.as_os_str() == "-" {
                return Err(field.wrong("a folder", "write a name such as \"results\""));
            }
            Ok(path)
        })?,
        frames_s: interval("frames")?,
        series_s: interval("series")?,
        checkpoint_s: interval("checkpoint")?,
    })
}
