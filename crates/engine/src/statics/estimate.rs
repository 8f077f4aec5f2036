//! Cost of a static run, estimated before it.

use dem_io::{Diagnostic, Result};
use serde::Serialize;

use super::degrees_of_freedom::DegreesOfFreedom;
use super::factor::Factor;
use super::matrix::Matrix;
use crate::state::State;

/// Cost of a static run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StaticsEstimate {
    /// Number of unknown degrees of freedom.
    pub unknowns: usize,
    /// Number of degrees of freedom held by supports.
    pub held: usize,
    /// Whether the tangent is treated as symmetric: no torque acts on particles with more than one
    /// free rotation.
    pub symmetric: bool,
    /// True if conjugate gradients take the place of factors.
    pub iterative: bool,
    /// Entries of its factor. None: unknown before the factorisation, or there is none.
    pub factor_entries: Option<usize>,
    /// Largest memory of matrix and factor, bytes; for a tangent that is not symmetric that of the
    /// matrix alone.
    pub memory_bytes: usize,
}

impl StaticsEstimate {
    /// For a planned state, with loads and supports until `end_s`; refused if even the pattern of
    /// the factor does not fit into memory.
    pub fn of(state: &State, end_s: f64) -> Result<Self> {
        let degrees_of_freedom = DegreesOfFreedom::new(state, end_s);
        let symmetric = !degrees_of_freedom.has_free_torques(state);
        let matrix = Matrix::pattern(state, &degrees_of_freedom, symmetric);
        let nodes = degrees_of_freedom.nodes(&state.particles.poses);
        let factor = Factor::new(&matrix, nodes).map_err(|_| {
            let remedy = "use fewer particles, or run.integrator = \"leapfrog\"";
            Diagnostic::failed("", "the stiffness does not fit into memory", remedy)
        })?;
        let factor_entries = factor.entries();
        let iterative = matches!(factor, Factor::Iterative(..));
        // Values and row indices, in the original order and in that of the factor.
        let of_matrix = 2 * 16 * matrix.rows.len();
        Ok(Self {
            unknowns: degrees_of_freedom.count,
            held: degrees_of_freedom.held(),
            symmetric,
            iterative,
            factor_entries,
            memory_bytes: of_matrix + 8 * factor_entries.unwrap_or(0),
        })
    }
}
