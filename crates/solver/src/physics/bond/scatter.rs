//! Strength that varies from bond to bond: a factor that follows the Weibull distribution of scale 1.
//!
//! It depends on nothing but the seed and the names of the bond, so it is the same in whatever order bonds are visited and on any number of threads,
//! and it need not be stored.

use crate::physics::random::uniform;

/// Factor on the strength of the bond between two particles of a body: (-ln(1 - u))^(1/m) with u uniform in (0, 1) and m the Weibull modulus.
///
/// The given strength is thus the scale of the distribution, which 63.2 % of the bonds do not reach; its mean is Gamma(1 + 1/m) of it.
/// An infinite modulus gives 1. It does not matter which particle is named first.
pub fn strength_factor(seed: u64, body: u64, particles: [u64; 2], weibull_modulus: f64) -> f64 {
    let [a, b] = particles;
    let uniform = uniform(seed, &[body, a.min(b), a.max(b)]);
    (-(-uniform).ln_1p()).powf(1.0 / weibull_modulus)
}
