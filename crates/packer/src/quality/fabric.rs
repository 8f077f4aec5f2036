//! Fabric: the preferred directions of bonds.
//!
//! The tensor is the mean of n n^T over the bonds, n the direction of a bond: isotropic, all
//! eigenvalues are 1/3. For N independent random directions each diagonal entry scatters by sigma =
//! sqrt(4/45/N), and 15/2 N |tensor - 1/3|^2 follows chi-squared with 5 degrees of freedom. The
//! largest of the three eigenvalue deviations is about 2 sigma even for such directions, so the
//! probability is more informative than the deviation in sigma.

use crate::spheres::Spheres;
use nalgebra::{Matrix3, SymmetricEigen};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Number of bonds summed by one task: fixed, so that the sum is the same for any number of
/// threads.
const CHUNK: usize = 8192;

/// Distribution of bond directions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fabric {
    /// Number of bonds counted.
    pub bonds: usize,
    /// Eigenvalues of the mean of n n^T, descending; their sum is 1. Length 3.
    pub eigenvalues: [f64; 3],
    /// Direction of the largest, a unit vector. Length 3.
    pub direction: [f64; 3],
    /// Statistical noise of a diagonal entry for this number of independent bonds.
    pub sigma: f64,
    /// Largest deviation of an eigenvalue from 1/3, in sigma.
    pub largest_deviation_in_sigma: f64,
    /// True if the largest deviation is at most 2 sigma.
    pub isotropic_within_2_sigma: bool,
    /// Probability that the same number of independent random directions deviates at least as much,
    /// 0 to 1.
    pub chance: f64,
}

/// The fabric of the bonds. Each end counts for half a bond if `counts` is true for its particle.
/// None if no end counts.
///
/// Counting only bonds with both ends in a region would favour directions along its border.
pub fn of(
    spheres: &Spheres,
    bonds: &[[u32; 2]],
    counts: impl Fn(u32) -> bool + Sync,
) -> Option<Fabric> {
    let parts: Vec<(usize, Matrix3<f64>)> = bonds
        .par_chunks(CHUNK)
        .map(|bonds| {
            let mut sum = Matrix3::zeros();
            let mut count = 0;
            for bond in bonds {
                let ends = bond.iter().filter(|i| counts(**i)).count();
                if ends == 0 {
                    continue;
                }
                let [p, q] = bond.map(|i| nalgebra::Vector3::from(spheres.positions[i as usize]));
                if let Some(direction) = (q - p).try_normalize(0.0) {
                    sum += direction * direction.transpose() * ends as f64;
                    count += ends;
                }
            }
            (count, sum)
        })
        .collect();
    let (ends, sum) = parts
        .iter()
        .fold((0, Matrix3::zeros()), |(n, sum), (m, part)| {
            (n + m, sum + part)
        });
    if ends == 0 {
        return None;
    }
    let tensor = sum / ends as f64;
    let count = ends.div_ceil(2);
    let eigen = SymmetricEigen::new(tensor);
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let eigenvalues = order.map(|i| eigen.eigenvalues[i]);
    let sigma = (4.0 / 45.0 / count as f64).sqrt();
    let largest = eigenvalues
        .iter()
        .map(|e| (e - 1.0 / 3.0).abs())
        .fold(0.0, f64::max);
    let squares: f64 = eigenvalues.iter().map(|e| (e - 1.0 / 3.0).powi(2)).sum();
    let largest_deviation_in_sigma = largest / sigma;
    Some(Fabric {
        bonds: count,
        eigenvalues,
        direction: eigen.eigenvectors.column(order[0]).into_owned().into(),
        sigma,
        largest_deviation_in_sigma,
        isotropic_within_2_sigma: largest_deviation_in_sigma <= 2.0,
        chance: chi_squared_5_exceeds(7.5 * count as f64 * squares),
    })
}

/// Probability that chi-squared with 5 degrees of freedom exceeds `x`: 1 - sqrt(2/pi)/3 integral of
/// t^4 exp(-t^2/2) from 0 to sqrt(x), by Simpson's rule.
pub fn chi_squared_5_exceeds(x: f64) -> f64 {
    const INTERVALS: u32 = 400;
    let end = x.sqrt().min(12.0);
    let step = end / f64::from(INTERVALS);
    let integral: f64 = (0..=INTERVALS)
        .map(|i| {
            let t = step * f64::from(i);
            let weight = if i == 0 || i == INTERVALS {
                1.0
            } else if i % 2 == 1 {
                4.0
            } else {
                2.0
            };
            weight * t.powi(4) * (-0.5 * t * t).exp()
        })
        .sum::<f64>()
        * step
        / 3.0;
    (1.0 - (2.0 / std::f64::consts::PI).sqrt() / 3.0 * integral).clamp(0.0, 1.0)
}
