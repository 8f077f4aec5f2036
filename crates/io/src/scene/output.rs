//! `[output]`

use std::path::Path;

use super::Output;
use super::direction::direction;
use super::field::Field;
use super::read::named_path;
use crate::Result;
use crate::units::TIME;

pub(super) fn read(field: &Field<'_>, folder: &Path) -> Result<Output> {
    let table = field.table(&[
        "folder",
        "frames",
        "series",
        "pictures",
        "view",
        "checkpoint",
    ])?;
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
        pictures_s: interval("pictures")?,
        view_from: table.read("view", |field| view(&field))?,
        checkpoint_s: interval("checkpoint")?,
    })
}

/// `{ from }` as a vector of length 1.
fn view(field: &Field<'_>) -> Result<[f64; 3]> {
    let table = field.table(&["from"])?;
    direction(&table.need("from", "[1, -2, 1]")?, "a direction")
}
