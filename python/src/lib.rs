//! `crumble._crumble`: what the Python package needs from the crates.
//! `package/crumble/_crumble.pyi` describes it; users see the functions of
//! `package/crumble/__init__.py`.

mod arrays;
mod body;
mod errors;
mod frames;
mod work;

use std::ffi::OsString;
use std::path::PathBuf;

use dem_io::own_command::set_own_command;
use dem_io::units::{TIME, quantity};
use dem_run::cli::Arguments;
use dem_run::interrupt::Interrupt;
use dem_scene::read_scene;
use pyo3::prelude::*;

use errors::python_error;
use work::{Told, interruptible};

#[pymodule]
fn _crumble(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<body::StoredBody>()?;
    module.add_function(wrap_pyfunction!(body::pack, module)?)?;
    module.add_function(wrap_pyfunction!(body::read_body, module)?)?;
    module.add_function(wrap_pyfunction!(run, module)?)?;
    module.add_function(wrap_pyfunction!(results_folder, module)?)?;
    module.add_function(wrap_pyfunction!(time_s, module)?)?;
    module.add_function(wrap_pyfunction!(frames::read_frame, module)?)?;
    module.add_function(wrap_pyfunction!(frames::read_walls, module)?)?;
    module.add_function(wrap_pyfunction!(program, module)?)?;
    Ok(())
}

/// Runs the command line of dem-run, without the name of the program. `command` is what starts the
/// program in a process of its own: a file and its first arguments. Calls `tell` with the fraction
/// done and a text. Ctrl-C stops the run; its results are written.
#[pyfunction]
fn run(
    py: Python<'_>,
    command: Vec<String>,
    arguments: Vec<OsString>,
    tell: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    starts_by(&command);
    let line = std::iter::once(OsString::from("dem-run")).chain(arguments);
    let arguments = Arguments::parsed(line).map_err(|error| python_error(py, &error))?;
    let interrupt = Interrupt::default();
    let told = Told::default();
    let stop = || {
        interrupt.ask();
    };
    interruptible(py, tell.as_ref(), &told, &stop, || {
        dem_run::cli::run(&arguments, &interrupt, &|fraction, text| {
            told.say(fraction, text.to_string());
        })
    })
}

/// The folder of the results that a scene has without `--output`, or would have if it asked for
/// results.
#[pyfunction]
fn results_folder(py: Python<'_>, scene: PathBuf, overrides: Vec<String>) -> PyResult<PathBuf> {
    let read = read_scene(&scene, &overrides).map_err(|error| python_error(py, &error))?;
    let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
    let by_name = || PathBuf::from(format!("{stem}-out"));
    Ok(read
        .output
        .and_then(|output| output.folder)
        .unwrap_or_else(by_name))
}

/// A time in s, from a text with or without a unit.
#[pyfunction]
fn time_s(py: Python<'_>, text: &str) -> PyResult<f64> {
    quantity(text, &TIME).map_err(|error| python_error(py, &error))
}

/// The program `dem-pack` or `dem-run` with these arguments. `command` is what starts it, as for
/// `run`. Returns the exit code.
#[pyfunction]
fn program(py: Python<'_>, name: &str, command: Vec<String>, arguments: Vec<OsString>) -> u8 {
    starts_by(&command);
    let line = std::iter::once(OsString::from(name)).chain(arguments);
    py.detach(|| match name {
        "dem-pack" => dem_pack::cli::program(line),
        _ => dem_run::cli::program(line),
    })
}

/// Says what starts the program: a study runs each of its runs in a process.
fn starts_by(command: &[String]) {
    if let Some((file, first)) = command.split_first() {
        set_own_command(PathBuf::from(file), first.to_vec());
    }
}
