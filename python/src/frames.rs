//! Frames of a run.

use std::path::PathBuf;

use dem_io::body::StoredWalls;
use dem_results::read_all_arrays;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{counts, floats, whole};
use crate::errors::python_error;

/// The time, the names of the bodies, and all arrays by their names, such as
/// `PointData/radius_m`.
#[pyfunction]
pub(crate) fn read_frame(
    py: Python<'_>,
    path: PathBuf,
) -> PyResult<(Option<f64>, Vec<String>, Bound<'_, PyDict>)> {
    let frame = py
        .detach(|| read_all_arrays(&path))
        .map_err(|error| python_error(py, &error))?;
    let arrays = PyDict::new(py);
    for (name, array) in frame.named() {
        let column = if array.is_whole {
            whole(py, &array.values, array.components)?
        } else {
            floats(py, &array.values, array.components)?
        };
        arrays.set_item(name, column)?;
    }
    Ok((frame.time_s, frame.body_names, arrays))
}

/// The time, the names of the walls, and their arrays.
#[pyfunction]
pub(crate) fn read_walls(
    py: Python<'_>,
    path: PathBuf,
) -> PyResult<(f64, Vec<String>, Bound<'_, PyDict>)> {
    let walls: StoredWalls = py
        .detach(|| dem_io::body::read_walls(&path))
        .map_err(|error| python_error(py, &error))?;
    let arrays = PyDict::new(py);
    arrays.set_item("force_n", floats(py, walls.forces_n.as_flattened(), 3)?)?;
    arrays.set_item("points_m", floats(py, walls.points_m.as_flattened(), 3)?)?;
    arrays.set_item("triangles", counts(py, walls.triangles.as_flattened(), 3)?)?;
    arrays.set_item("wall", counts(py, &walls.wall_of_triangle, 1)?)?;
    Ok((walls.time_s, walls.names, arrays))
}
