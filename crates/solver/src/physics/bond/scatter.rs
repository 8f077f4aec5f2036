//! Strength that varies from bond to bond: a factor that follows the Weibull distribution of scale 1.
//!
//! It depends on nothing but the seed and the names of the bond, so it is the same in whatever order bonds are visited and on any number of threads,
//! and it need not be stored.

/// Factor on the strength of the bond between two particles of a body: (-ln(1 - u))^(1/m) with u uniform in (0, 1) and m the Weibull modulus.
///
/// The given strength is thus the scale of the distribution, which 63.2 % of the bonds do not reach; its mean is Gamma(1 + 1/m) of it.
/// An infinite modulus gives 1. It does not matter which particle is named first.
pub fn strength_factor(seed: u64, body: u64, particles: [u64; 2], weibull_modulus: f64) -> f64 {
    let [a, b] = particles;
    let words = [body, a.min(b), a.max(b)];
    let hash = words
        .iter()
        .fold(mixed(seed), |hash, &word| mixed(hash ^ word));
    // 53 bits, in the middle of their interval: neither 0 nor 1.
    let uniform = ((hash >> 11) as f64 + 0.5) * (0.5 * f64::EPSILON);
    (-(-uniform).ln_1p()).powf(1.0 / weibull_modulus)
}

/// One step of SplitMix64 (Steele, Lea and Flood 2014).
fn mixed(state: u64) -> u64 {
    let z = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
