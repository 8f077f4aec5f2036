//! Bodies: packing, reading, writing.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use dem_io::body::files::body_files;
use dem_io::body::write_body;
use dem_io::write_target::refuse_to_replace;
use dem_io::{Body, Diagnostic, Result};
use dem_pack::BodyReport;
use dem_pack::cli::{Recipe, thread_pool};
use dem_results::folder::make_folder;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{counts, floats};
use crate::errors::python_error;
use crate::work::{Told, interruptible};

/// A body in memory.
#[pyclass(frozen)]
pub(crate) struct StoredBody(Body);

#[pymethods]
impl StoredBody {
    /// Its arrays by the names of the .vtp, with the particles of each bond as `bonds`.
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let body = &self.0;
        let arrays = PyDict::new(py);
        arrays.set_item("position_m", floats(py, body.positions.as_flattened(), 3)?)?;
        arrays.set_item("radius_m", floats(py, &body.radii, 1)?)?;
        arrays.set_item("bonds", counts(py, body.bonds.as_flattened(), 2)?)?;
        arrays.set_item("bond_radius_m", floats(py, &body.bond_radii, 1)?)?;
        arrays.set_item("initial_length_m", floats(py, &body.bond_lengths, 1)?)?;
        Ok(arrays)
    }

    /// Its origin as JSON.
    fn about(&self) -> String {
        serde_json::to_string(&self.0.about).unwrap_or_default()
    }

    /// A sentence on few particles across its thinnest part. None: there are enough, or their
    /// number is unknown.
    fn coarse(&self) -> Option<String> {
        self.0.about.coarse()
    }

    /// Writes it; the ending of the name gives the format. Its folder is made.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| make_folder_of(&path).and_then(|()| write_body(&self.0, &path)))
            .map_err(|error| python_error(py, &error))
    }
}

/// Reads a body.
#[pyfunction]
pub(crate) fn read_body(py: Python<'_>, path: PathBuf) -> PyResult<StoredBody> {
    py.detach(|| dem_io::body::read_body(&path))
        .map(StoredBody)
        .map_err(|error| python_error(py, &error))
}

/// The body and the report (JSON) that a command line of dem-pack gives, without the name of the
/// program, `--output` and `--threads`.
#[pyfunction]
pub(crate) fn pack(
    py: Python<'_>,
    arguments: Vec<String>,
    output: Option<PathBuf>,
    threads: Option<usize>,
    tell: Option<Bound<'_, PyAny>>,
) -> PyResult<(StoredBody, String)> {
    let stopping = AtomicBool::new(false);
    let told = Told::default();
    let stop = || stopping.store(true, Ordering::Relaxed);
    let (body, report) = interruptible(py, tell.as_ref(), &told, &stop, || {
        let pool = thread_pool(threads)?;
        pool.install(|| packed(&arguments, output.as_deref(), &told, &stopping))
    })?;
    let report = serde_json::to_string(&report).unwrap_or_default();
    Ok((StoredBody(body), report))
}

fn packed(
    arguments: &[String],
    output: Option<&Path>,
    told: &Told,
    stopping: &AtomicBool,
) -> Result<(Body, BodyReport)> {
    let recipe = Recipe::parse(arguments)?;
    if let Some(output) = output {
        refuse_to_replace(&body_files(output)?, &recipe.files())?;
        make_folder_of(output)?;
    }
    let (body, report) = recipe.make(recipe.seed(), &|stage, done| {
        told.say(done.clamp(0.0, 1.0), stage.to_owned());
        match stopping.load(Ordering::Relaxed) {
            true => Err(Diagnostic::interrupted("interrupted", "")),
            false => Ok(()),
        }
    })?;
    if let Some(output) = output {
        write_body(&body, output)?;
    }
    Ok((body, report))
}

/// Makes the folder of a file, with those that it is in.
fn make_folder_of(file: &Path) -> Result<()> {
    match file.parent().filter(|folder| *folder != Path::new("")) {
        Some(folder) => make_folder(folder),
        None => Ok(()),
    }
}
