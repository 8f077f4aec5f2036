//! What a static run will take, before it is run.

use dem_io::{Diagnostic, Result};
use serde::Serialize;

use super::degrees_of_freedom::DegreesOfFreedom;
use super::factor::Factor;
use super::matrix::Matrix;
use crate::state::State;

/// What a static run will take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StaticsEstimate {
    /// Unknown degrees_of_freedom.
    pub unknowns: usize,
    /// Freedoms that supports hold.
    pub held: usize,
    /// Whether the tangent is taken as symmetric: no torque acts on particles that are free to turn
    /// in more displacements than one.
    pub symmetric: bool,
    /// Entries of its factor. None: they are not known before it is there.
    pub factor_entries: Option<usize>,
    /// Largest memory of matrix and factor, bytes; of a tangent that is not symmetric that of the
    /// matrix alone.
    pub memory_bytes: usize,
}

impl StaticsEstimate {
    /// Of a planned state, with loads and supports until `end_s`.
    ///
    /// # Errors
    /// Not even the pattern of the factor fits into memory.
    pub fn of(state: &State, end_s: f64) -> Result<Self> {
        let degrees_of_freedom = DegreesOfFreedom::new(state, end_s);
        let symmetric = !degrees_of_freedom.has_free_torques(state);
        let matrix = Matrix::pattern(state, &degrees_of_freedom, symmetric);
        let factor = Factor::new(&matrix).map_err(|_| {
            let remedy = "use fewer particles, or run.integrator = \"leapfrog\"";
            Diagnostic::failed("", "the stiffness does not fit into memory", remedy)
        })?;
        let factor_entries = factor.entries();
        // Values and rows, as they are and in the order of the factor.
        let of_matrix = 2 * 16 * matrix.rows.len();
        Ok(Self {
            unknowns: degrees_of_freedom.count,
            held: degrees_of_freedom.held(),
            symmetric,
            factor_entries,
            memory_bytes: of_matrix + 8 * factor_entries.unwrap_or(0),
        })
    }
}
