//! Agreement of the sizes placed with those requested: one-sample Kolmogorov-Smirnov distances.

use super::distribution::Sizes;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The Kolmogorov-Smirnov distance of 95 % of large samples is below this, divided by the square
/// root of their size.
const LIMIT_95: f64 = 1.358;

/// The largest difference between the distribution of a sample and the requested one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// The largest difference between the two distribution functions, 0 to 1.
    pub distance: f64,
    /// Limit for 95 % of random samples of this size: 1.358/sqrt(n), n the effective size.
    pub limit_95: f64,
    /// Number of particles; by mass (sum of masses)^2 / (sum of squared masses).
    pub effective_samples: f64,
}

impl Fit {
    /// True if the distance is within the statistical limit.
    pub fn passes(&self) -> bool {
        self.distance <= self.limit_95
    }
}

/// Distance between the fractions by number of these diameters (m) and of `sizes`. No diameters:
/// distance 0.
pub fn ks_distance_by_number(diameters_m: &[f64], sizes: &Sizes) -> Fit {
    distance(diameters_m, sizes, |_| 1.0, |d| sizes.cdf_by_number(d))
}

/// Distance between the fractions by mass of these diameters (m) and of `sizes`: each particle
/// weighs the third power of its diameter. The limit takes the effective number of particles for a
/// plain sample, a good approximation.
pub fn ks_distance_by_mass(diameters_m: &[f64], sizes: &Sizes) -> Fit {
    let largest = sizes.max_m();
    distance(
        diameters_m,
        sizes,
        |d| (d / largest).powi(3),
        |d| sizes.cdf_by_mass(d),
    )
}

fn distance(
    diameters_m: &[f64],
    sizes: &Sizes,
    weight: impl Fn(f64) -> f64,
    cdf: impl Fn(f64) -> f64,
) -> Fit {
    let mut sorted = diameters_m.to_vec();
    sorted.par_sort_unstable_by(f64::total_cmp);
    let total: f64 = sorted.iter().map(|d| weight(*d)).sum();
    let squares: f64 = sorted.iter().map(|d| weight(*d).powi(2)).sum();
    let effective_samples = if squares > 0.0 {
        total * total / squares
    } else {
        0.0
    };
    let mut distance = 0.0_f64;
    let mut below = 0.0;
    for diameter in &sorted {
        let fraction = weight(*diameter) / total;
        if sizes.is_one_size() {
            // A step: only the fraction that differs from it by more than rounding counts.
            distance += if (diameter / sizes.min_m() - 1.0).abs() > 1e-9 {
                fraction
            } else {
                0.0
            };
        } else {
            let wanted = cdf(*diameter);
            distance = distance
                .max((wanted - below).abs())
                .max((wanted - below - fraction).abs());
        }
        below += fraction;
    }
    let limit_95 = if effective_samples > 0.0 {
        LIMIT_95 / effective_samples.sqrt()
    } else {
        1.0
    };
    Fit {
        distance,
        limit_95,
        effective_samples,
    }
}
