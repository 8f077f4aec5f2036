//! The walls of a frame, and their loads.

use std::path::PathBuf;

use dem_io::Result;
use dem_io::body::read_walls;
use dem_io::body::stored_walls::StoredWalls;

use super::choose::ChosenFrame;
use crate::load_cells::LoadCells;

/// Reads the walls that stand beside a frame. None: the scene has none.
pub(crate) fn read(frame: &ChosenFrame) -> Result<Option<StoredWalls>> {
    beside(frame, "walls_")
        .map(|path| read_walls(&path))
        .transpose()
}

/// Reads the patches of walls on which something has pressed before a frame. None: no wall has
/// loads.
pub(crate) fn read_loads(frame: &ChosenFrame) -> Result<Option<LoadCells>> {
    let Some(path) = beside(frame, "loads_") else {
        return Ok(None);
    };
    Ok(Some(LoadCells::read(&path)?.touched()))
}

/// The file beside a frame that begins so.
fn beside(frame: &ChosenFrame, part: &str) -> Option<PathBuf> {
    let name = frame.path.file_name().unwrap_or_default().to_string_lossy();
    let other = name.replace("frame_", part);
    let path = frame.path.with_file_name(&other);
    (name != other && path.is_file()).then_some(path)
}
