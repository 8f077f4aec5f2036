//! Uniform random numbers from a generator of a few lines, independent of the program's generator.

use std::f64::consts::PI;

/// Uniform numbers in [0, 1), splitmix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// A direction, all equally likely.
    pub(crate) fn direction(&mut self) -> [f64; 3] {
        let (z, phi) = (2.0 * self.next() - 1.0, 2.0 * PI * self.next());
        let rho = (1.0 - z * z).sqrt();
        [rho * phi.cos(), rho * phi.sin(), z]
    }
}
