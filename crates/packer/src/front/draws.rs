//! Random draws of sizes, as quantiles of the distribution by number (0 to 1).

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Draws sizes one after the other. Each waits until it finds a place, so that the sizes placed are
/// the sizes drawn.
pub(super) struct Draws {
    pub(super) random: ChaCha8Rng,
    /// The draw that waits for a place.
    pub(super) waiting: Option<f64>,
}

impl Draws {
    /// Draws of one stream of random numbers, after those that are already waiting.
    pub(super) fn new(seed: u64, stream: u64, waiting: Option<f64>) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(stream);
        Self { random, waiting }
    }

    /// The waiting draw, made by `draw` if none waits.
    pub(super) fn current(&mut self, draw: impl FnOnce(&mut ChaCha8Rng) -> f64) -> f64 {
        *self.waiting.get_or_insert_with(|| draw(&mut self.random))
    }

    /// Records that the waiting draw has found its place.
    pub(super) fn placed(&mut self) {
        self.waiting = None;
    }
}

/// A draw from the complete distribution.
pub(super) fn any_size(random: &mut ChaCha8Rng) -> f64 {
    random.random::<f64>()
}

/// The first draw of a stream of random numbers.
pub(crate) fn first_draw(seed: u64, stream: u64) -> f64 {
    any_size(&mut Draws::new(seed, stream, None).random)
}
