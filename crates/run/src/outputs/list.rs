//! The list of the outputs of a run.

use dem_io::Result;

use super::{
    Opening, Output, Outputs, discharge, event_table, fragments, frames, pictures, series,
};

/// Opens an output. None: the run has no use for it.
type Open = fn(&Opening<'_>) -> Result<Option<Box<dyn Output>>>;

/// All outputs that a run may have, by their names in the checkpoint, in the order in which they
/// are written.
const OUTPUTS: [(&str, Open); 6] = [
    ("series", series::open),
    ("events", event_table::open),
    ("frames", frames::open),
    (pictures::NAME, pictures::open),
    ("fragments", fragments::open),
    ("discharge", discharge::open),
];

/// Opens the files of a run, new or where it is continued. Files that are not those of the
/// checkpoint are refused (exit code 2) before any is changed.
pub(crate) fn open_outputs(opening: &Opening<'_>) -> Result<Outputs> {
    if let Some(progress) = opening.continued {
        progress.sums.check(opening.folder.path())?;
    }
    let mut outputs = Vec::new();
    for (name, open) in OUTPUTS {
        let output = open(&Opening { name, ..*opening })?;
        outputs.extend(output.map(|output| (name, output)));
    }
    Ok(outputs)
}
