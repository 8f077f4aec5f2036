//! The walls of a frame.

use dem_io::Result;
use dem_results::read_arrays;

use super::choose::ChosenFrame;

/// The triangles of all walls of a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Walls {
    pub(crate) corners_m: Vec<[f64; 3]>,
    /// The three corners of each triangle.
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// Reads the walls that stand beside a frame. None: the scene has none.
///
/// # Errors
/// Their file is damaged (exit code 2).
pub(crate) fn read(frame: &ChosenFrame) -> Result<Option<Walls>> {
    let name = frame.path.file_name().unwrap_or_default().to_string_lossy();
    let path = frame.path.with_file_name(name.replace("frame_", "walls_"));
    if name == path.file_name().unwrap_or_default().to_string_lossy() || !path.is_file() {
        return Ok(None);
    }
    let [places, corners] = ["Points/positions_m", "Polys/connectivity"];
    let arrays = read_arrays(&path, &[places, corners])?;
    let (corners_m, _) = arrays.get(places).unwrap_or_default().as_chunks::<3>();
    let (triangles, _) = arrays.get(corners).unwrap_or_default().as_chunks::<3>();
    let known = |triangle: &&[f64; 3]| triangle.iter().all(|at| (*at as usize) < corners_m.len());
    Ok(Some(Walls {
        corners_m: corners_m.to_vec(),
        triangles: (triangles.iter().filter(known))
            .map(|triangle| triangle.map(|at| at as u32))
            .collect(),
    }))
}
