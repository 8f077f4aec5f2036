//! Weighted least squares of a step.

use nalgebra::{DMatrix, DVector};

/// Singular values below this fraction of the largest count as 0: such a combination of numbers
/// moves the results too little for a step along it.
const SMALLEST: f64 = 0.02;

/// Changes x of the logarithms of the factors with which the sum over the results of
/// ((J x - wanted)/tolerance)² is smallest, and of all those the smallest x: with as many results
/// as unknowns, or more, by singular values (Golub and Van Loan 2013, section 5.5).
/// `slopes`: J, a row for each result.
pub fn weighted_step(slopes: &DMatrix<f64>, wanted: &[f64], tolerances: &[f64]) -> DVector<f64> {
    let mut matrix = slopes.clone();
    for (mut row, tolerance) in matrix.row_iter_mut().zip(tolerances) {
        row /= *tolerance;
    }
    let pairs = wanted.iter().zip(tolerances);
    let right = DVector::from_iterator(wanted.len(), pairs.map(|(wanted, of)| wanted / of));
    let none = DVector::zeros(slopes.ncols());
    if wanted.is_empty() {
        return none;
    }
    let svd = matrix.svd(true, true);
    let largest = svd.singular_values.amax();
    svd.solve(&right, SMALLEST * largest).unwrap_or(none)
}
