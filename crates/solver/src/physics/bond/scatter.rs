//! Strength that varies from bond to bond: a factor that follows the Weibull distribution of scale
//! 1.
//!
//! It depends on nothing but the seed and the names of the bond: the body's name in the scene and
//! the numbers of the bond's particles in the body's file. So it is the same in whatever order
//! bonds
//! are listed or visited, on any number of threads, and whatever other bodies there are; and it
//! need
//! not be stored.

use dem_io::random::{hash, uniform};

/// What stands for a body in [`strength_factor`]: its name in the scene, and for bodies that come
/// through inlets how many came before it. 0: it stood there at the start, bonded or as a clump.
pub fn body_key(name: &str, instance: u32) -> u64 {
    hash(u64::from(instance), name.bytes().map(u64::from))
}

/// Factor on the strength of the bond between two particles of a body (its [`body_key`]):
/// (-ln(1 - u))^(1/m) with u uniform in (0, 1) and m the Weibull modulus.
///
/// The given strength is thus the scale of the distribution, which 63.2 % of the bonds do not
/// reach; its mean is Gamma(1 + 1/m) of it. An infinite modulus gives 1. It does not matter which
/// particle is named first.
pub fn strength_factor(seed: u64, body: u64, particles: [u64; 2], weibull_modulus: f64) -> f64 {
    let [a, b] = particles;
    let uniform = uniform(seed, &[body, a.min(b), a.max(b)]);
    (-(-uniform).ln_1p()).powf(1.0 / weibull_modulus)
}
