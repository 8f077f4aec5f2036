//! Numbers that look random and depend only on their keys: no state is needed, and the order of the
//! calls does not matter.

/// A hash of a seed and words, in their order.
pub fn hash(seed: u64, words: impl IntoIterator<Item = u64>) -> u64 {
    words
        .into_iter()
        .fold(mixed(seed), |hash, word| mixed(hash ^ word))
}

/// A number in (0, 1), uniform over all seeds and words.
pub fn uniform(seed: u64, words: &[u64]) -> f64 {
    let hash = hash(seed, words.iter().copied());
    // 53 bits, in the middle of their interval: neither 0 nor 1.
    ((hash >> 11) as f64 + 0.5) * (0.5 * f64::EPSILON)
}

/// Increment of SplitMix64 in each step.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// Number `n` of the sequence of SplitMix64 that starts at 0.
pub fn nth(n: u64) -> u64 {
    mixed(n.wrapping_mul(STEP))
}

/// One step of SplitMix64 (Steele et al. 2014).
fn mixed(state: u64) -> u64 {
    let z = state.wrapping_add(STEP);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
