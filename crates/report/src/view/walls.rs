//! The walls of a frame.

use dem_io::Result;
use dem_io::body::read_walls;
use dem_io::body::stored_walls::StoredWalls;

use super::choose::ChosenFrame;

/// Reads the walls that stand beside a frame. None: the scene has none.
pub(crate) fn read(frame: &ChosenFrame) -> Result<Option<StoredWalls>> {
    let name = frame.path.file_name().unwrap_or_default().to_string_lossy();
    let of_walls = name.replace("frame_", "walls_");
    let path = frame.path.with_file_name(&of_walls);
    if name == of_walls || !path.is_file() {
        return Ok(None);
    }
    read_walls(&path).map(Some)
}
