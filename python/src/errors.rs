//! Messages of the programs as Python exceptions.

use dem_io::Diagnostic;
use pyo3::prelude::*;

/// `crumble.Error` with the message, its parts and the exit code that the program would have.
pub(crate) fn python_error(py: Python<'_>, problem: &Diagnostic) -> PyErr {
    let made = py
        .import("crumble._errors")
        .and_then(|module| module.getattr("Error"))
        .and_then(|class| {
            class.call1((
                problem.to_string(),
                problem.exit_code(),
                &problem.place,
                &problem.problem,
                &problem.remedy,
            ))
        });
    made.map_or_else(|error| error, PyErr::from_value)
}
