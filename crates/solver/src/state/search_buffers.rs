//! Vectors of the neighbour search, kept from one search to the next for their memory only.

use super::balls::{Ball, BoxColumns};
use super::grids::Grids;
use crate::geometry::Bounds;

/// What is to be searched for.
#[derive(Debug, Clone, Default)]
pub struct Due {
    /// Free particles, ascending.
    pub(crate) particles: Vec<u32>,
    /// Numbers of clumps, ascending.
    pub(crate) clumps: Vec<usize>,
}

impl Due {
    pub(crate) fn is_empty(&self) -> bool {
        self.particles.is_empty() && self.clumps.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.particles.clear();
        self.clumps.clear();
    }
}

/// Vectors of a search.
#[derive(Debug, Clone, Default)]
pub struct SearchBuffers {
    /// What is due.
    pub(crate) due: Due,
    /// For each particle whether it is due.
    pub(crate) seeks: Vec<bool>,
    /// What is due and is in no large cluster.
    pub(crate) small: Vec<u32>,
    /// The particles that a wall reaches: those that each task found.
    pub(crate) reached: Vec<Vec<u32>>,
    /// Of the search for pairs.
    pub(crate) pairs: PairBuffers,
    /// Of the list of spheres of clumps that are near something.
    pub(crate) near: NearBuffers,
    /// Of a search where bodies may sleep.
    pub(crate) awake: AwakeBuffers,
}

/// Vectors of a search among what is awake and what sleeps beside it.
#[derive(Debug, Clone, Default)]
pub struct AwakeBuffers {
    /// Boxes around those that are awake: those that each task found, and all of them.
    pub(crate) box_tasks: Vec<Vec<Bounds>>,
    pub(crate) boxes: Vec<Bounds>,
    /// The particles that may be in a pair: those that each task found, and all of them.
    pub(crate) tasks: Vec<AwakeTask>,
    pub(crate) particles: Vec<u32>,
    /// The number of the cluster of each, and its ball.
    pub(crate) clusters: Vec<u32>,
    pub(crate) balls: Vec<Ball>,
}

/// Vectors of a task that looks for what may be in a pair with something awake.
#[derive(Debug, Clone, Default)]
pub struct AwakeTask {
    /// Numbers of the boxes that reach to the sleepers of its chunk.
    pub(crate) boxes: Vec<u32>,
    pub(crate) particles: Vec<u32>,
}

/// Vectors that list which spheres of clumps are near something.
#[derive(Debug, Clone, Default)]
pub struct NearBuffers {
    /// A bit for each sphere.
    pub(crate) bits: Vec<u64>,
    /// Those that were near before.
    pub(crate) former: Vec<u32>,
}

/// Vectors of a search for pairs.
#[derive(Debug, Clone, Default)]
pub struct PairBuffers {
    /// Numbers of the small clusters.
    pub(crate) small: Vec<u32>,
    /// The balls that may be in a pair with one of a small cluster, and their numbers.
    pub(crate) active: Vec<(u32, Ball)>,
    /// Their grids.
    pub(crate) grids: Grids,
    /// What each task found.
    pub(crate) of_tasks: Vec<PairTask>,
    /// All pairs found.
    pub(crate) found: Vec<[u32; 2]>,
}

/// Vectors of a task that searches for pairs.
#[derive(Debug, Clone, Default)]
pub struct PairTask {
    pub(crate) found: Vec<[u32; 2]>,
    /// Boxes of each of two clusters in the axes of the other.
    pub(crate) placed: [Vec<BoxColumns>; 2],
}
