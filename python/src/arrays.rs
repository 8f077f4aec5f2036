//! Numbers as bytes that numpy takes as they are: little endian, in the order of the files.

use pyo3::prelude::*;
use pyo3::types::PyByteArray;

/// An array for Python: its bytes, the type of its numbers in numpy's words, and the numbers in a
/// row: 1, or 3 for vectors.
pub(crate) type Column<'py> = (Bound<'py, PyByteArray>, &'static str, usize);

pub(crate) fn floats<'py>(py: Python<'py>, values: &[f64], row: usize) -> PyResult<Column<'py>> {
    Ok((bytes(py, values, f64::to_le_bytes)?, "<f8", row))
}

/// Whole numbers that were read as f64, which holds them exactly up to 2^53.
pub(crate) fn whole<'py>(py: Python<'py>, values: &[f64], row: usize) -> PyResult<Column<'py>> {
    let integer = |value: f64| (value as i64).to_le_bytes();
    Ok((bytes(py, values, integer)?, "<i8", row))
}

pub(crate) fn counts<'py>(py: Python<'py>, values: &[u32], row: usize) -> PyResult<Column<'py>> {
    let integer = |value: u32| i64::from(value).to_le_bytes();
    Ok((bytes(py, values, integer)?, "<i8", row))
}

fn bytes<'py, T: Copy>(
    py: Python<'py>,
    values: &[T],
    number: impl Fn(T) -> [u8; 8],
) -> PyResult<Bound<'py, PyByteArray>> {
    PyByteArray::new_with(py, 8 * values.len(), |buffer| {
        let (places, _) = buffer.as_chunks_mut::<8>();
        for (place, value) in places.iter_mut().zip(values) {
            *place = number(*value);
        }
        Ok(())
    })
}
