//! Strength that varies from bond to bond: a factor that follows the Weibull distribution of scale
//! 1.
//!
//! It depends only on the seed and the identity of the bond: the body's name in the scene and the
//! numbers of the bond's particles in the body's file. So it does not depend on the order in which
//! bonds are listed or visited, on the number of threads, or on other bodies; and it need not be
//! stored.

use dem_io::random::{hash, uniform};

/// Key of a body for [`strength_factor`]: its name in the scene, and for bodies that come through
/// inlets the number of bodies before it. 0: it was there at the start, bonded or as a clump.
pub fn body_key(name: &str, instance: u32) -> u64 {
    hash(u64::from(instance), name.bytes().map(u64::from))
}

/// Factor on the strength of the bond between two particles of a body (its `body_key`):
/// (-ln(1 - u))^(1/m) with u uniform in (0, 1) and m the Weibull modulus.
///
/// The given strength is thus the scale of the distribution: 63.2 % of the bonds are weaker, and
/// the mean is Gamma(1 + 1/m) times it. An infinite modulus gives 1. The order of the two particles
/// does not matter.
pub fn strength_factor(seed: u64, body: u64, particles: [u64; 2], weibull_modulus: f64) -> f64 {
    let [a, b] = particles;
    let uniform = uniform(seed, &[body, a.min(b), a.max(b)]);
    (-(-uniform).ln_1p()).powf(1.0 / weibull_modulus)
}
