//! Linear systems with the tangent: by factors, or without them if they would be large.

use super::conjugate::ConjugateGradients;
use super::degrees_of_freedom::Node;
use super::direct::{DirectFactor, NoFactor};
use super::matrix::Matrix;

/// Number of unknowns from which conjugate gradients need less time and memory than factors, whose
/// entries grow with the power 4/3 of it.
const ITERATIVE_FROM: usize = 40_000;

/// The means to solve systems with matrices of one pattern.
#[derive(Debug)]
pub enum Factor {
    /// Factors.
    Direct(Box<DirectFactor>),
    /// Conjugate gradients, for symmetric matrices: the nodes of the unknowns, and the last matrix.
    Iterative(Vec<Node>, Option<Box<ConjugateGradients>>),
}

impl Factor {
    /// For matrices of this pattern, whose unknowns have these nodes.
    pub fn new(matrix: &Matrix, nodes: Vec<Node>) -> Result<Self, NoFactor> {
        if matrix.symmetric && nodes.len() >= ITERATIVE_FROM {
            return Ok(Self::Iterative(nodes, None));
        }
        DirectFactor::new(matrix).map(|factor| Self::Direct(Box::new(factor)))
    }

    /// Entries of the factor; None if unknown before the factorisation, or if there is none.
    pub(crate) fn entries(&self) -> Option<usize> {
        match self {
            Self::Direct(factor) => factor.entries(),
            Self::Iterative(..) => None,
        }
    }

    /// Takes a matrix of the pattern.
    pub fn compute(&mut self, matrix: &Matrix) -> Result<(), NoFactor> {
        match self {
            Self::Direct(factor) => factor.compute(matrix),
            Self::Iterative(nodes, last) => {
                // Frees the old one first.
                *last = None;
                *last = Some(Box::new(ConjugateGradients::new(matrix, nodes)?));
                Ok(())
            }
        }
    }

    /// Replaces the right-hand side by the solution, with the matrix computed last; without one it
    /// stays as it is. `accuracy`: fraction to which conjugate gradients reduce the residual.
    /// Direct factors do not fail.
    pub(crate) fn solve(&self, side: &mut [f64], accuracy: f64) -> Result<(), NoFactor> {
        match self {
            Self::Direct(factor) => factor.solve(side),
            Self::Iterative(_, Some(last)) => {
                last.solve(side, accuracy)?;
            }
            Self::Iterative(_, None) => {}
        }
        Ok(())
    }
}
