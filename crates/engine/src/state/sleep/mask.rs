//! Particles that are not stepped.

use std::ops::Deref;

use serde::{Deserialize, Serialize};

/// Particles handled by one task.
pub const CHUNK: usize = 1024;

/// For each particle whether it is not stepped: its body sleeps, or it is of another group than the
/// one that is stepped now. Empty: all are stepped.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<bool>", into = "Vec<bool>")]
pub struct Asleep {
    each: Vec<bool>,
    /// For each [`CHUNK`] of particles whether all sleep.
    chunks: Vec<bool>,
}

impl Asleep {
    /// Whether all particles of a chunk sleep.
    #[inline]
    pub(crate) fn is_whole(&self, chunk: usize) -> bool {
        self.chunks.get(chunk).is_some_and(|all| *all)
    }
}

impl From<Vec<bool>> for Asleep {
    fn from(each: Vec<bool>) -> Self {
        let all = |some: &[bool]| !some.contains(&false);
        let chunks = each.chunks(CHUNK).map(all).collect();
        Self { each, chunks }
    }
}

impl From<Asleep> for Vec<bool> {
    fn from(asleep: Asleep) -> Self {
        asleep.each
    }
}

impl Deref for Asleep {
    type Target = [bool];

    fn deref(&self) -> &[bool] {
        &self.each
    }
}
