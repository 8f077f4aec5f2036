//! Linear systems with the tangent by sparse factorisation with an order that reduces
//! fill-in: Cholesky if it is symmetric, otherwise LU.
//!
//! A single thread does the work, so the results are the same, bit for bit, for any number of
//! threads.

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::solvers::{LltError, SolveCore};
use faer::mat::MatMut;
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, factorize_symbolic_cholesky};
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Side};

use super::matrix::Matrix;
use dem_physics::lanes::has_whole_sets;

/// Factors of matrices of one pattern.
#[derive(Debug)]
pub enum DirectFactor {
    /// For symmetric matrices, L L^T, by an approximate minimum degree order. The pattern of L, and
    /// its entries.
    Cholesky(SymbolicCholesky<usize>, Vec<f64>),
    /// For others, L U with partial pivoting, by an approximate minimum degree order of the
    /// columns. The patterns, and the factors once computed.
    Gauss(SymbolicLu<usize>, Option<Lu<usize, f64>>),
}

/// Reason why there are no factors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NoFactor {
    /// A pivot is zero, negative or not a number: the matrix is not positive definite or, if it is
    /// not symmetric, singular.
    Pivot,
    /// Conjugate gradients do not converge.
    NoConvergence,
    /// They do not fit into memory.
    Memory,
    /// The library that computes them does not work on this processor.
    Processor,
}

impl DirectFactor {
    /// Finds an order for matrices of this pattern, and the pattern of their factors.
    pub fn new(matrix: &Matrix) -> Result<Self, NoFactor> {
        let pattern = pattern(matrix);
        if !matrix.symmetric {
            let symbolic = SymbolicLu::try_new(pattern).map_err(|_| NoFactor::Memory)?;
            return Ok(Self::Gauss(symbolic, None));
        }
        let usual = (Default::default(), Default::default());
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, usual.0, usual.1);
        let symbolic = symbolic.map_err(|_| NoFactor::Memory)?;
        Ok(Self::Cholesky(symbolic, Vec::new()))
    }

    /// Entries of the factor; None if unknown before the factorisation.
    pub fn entries(&self) -> Option<usize> {
        match self {
            Self::Cholesky(symbolic, _) => Some(symbolic.len_val()),
            Self::Gauss(..) => None,
        }
    }

    /// Computes the factors of a matrix of the pattern.
    pub fn compute(&mut self, matrix: &Matrix) -> Result<(), NoFactor> {
        if !has_whole_sets() {
            return Err(NoFactor::Processor);
        }
        let values = SparseColMatRef::new(pattern(matrix), &matrix.values);
        match self {
            Self::Cholesky(symbolic, entries) => {
                if entries.is_empty() {
                    let needed = symbolic.len_val();
                    let got = entries.try_reserve_exact(needed);
                    got.map_err(|_| NoFactor::Memory)?;
                    entries.resize(needed, 0.0);
                }
                let room =
                    symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
                let mut room = MemBuffer::try_new(room).map_err(|_| NoFactor::Memory)?;
                let done = symbolic.factorize_numeric_llt(
                    entries,
                    values,
                    Side::Lower,
                    Default::default(),
                    Par::Seq,
                    MemStack::new(&mut room),
                    Default::default(),
                );
                match done {
                    Ok(_) => Ok(()),
                    Err(LltError::NonPositivePivot { .. }) => Err(NoFactor::Pivot),
                }
            }
            Self::Gauss(symbolic, factors) => {
                // Frees the old factors first: there may be room for one set only.
                *factors = None;
                let new = Lu::try_new_with_symbolic(symbolic.clone(), values);
                *factors = Some(new.map_err(|error| match error {
                    faer::sparse::linalg::LuError::SymbolicSingular { .. } => NoFactor::Pivot,
                    faer::sparse::linalg::LuError::Generic(_) => NoFactor::Memory,
                })?);
                Ok(())
            }
        }
    }

    /// Replaces the right-hand side by the solution, with the factors computed last; without
    /// factors it stays as it is.
    pub fn solve(&self, side: &mut [f64]) {
        let rows = side.len();
        let side = MatMut::from_column_major_slice_mut(side, rows, 1);
        match self {
            Self::Cholesky(symbolic, entries) if !entries.is_empty() => {
                let room = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
                LltRef::new(symbolic, entries).solve_in_place_with_conj(
                    Conj::No,
                    side,
                    Par::Seq,
                    MemStack::new(&mut MemBuffer::new(room)),
                );
            }
            Self::Gauss(_, Some(factors)) => factors.solve_in_place_with_conj(Conj::No, side),
            _ => {}
        }
    }
}

fn pattern(matrix: &Matrix) -> SymbolicSparseColMatRef<'_, usize> {
    let size = matrix.starts.len() - 1;
    SymbolicSparseColMatRef::new_checked(size, size, &matrix.starts, None, &matrix.rows)
}
