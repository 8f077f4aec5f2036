//! Vectors of the neighbour search, kept from one search to the next for their memory only.

use super::clusters::KnownClusters;
use dem_physics::geometry::Bounds;
use dem_physics::geometry::balls::{Ball, BoxColumns};
use dem_physics::geometry::grids::Grids;

/// What is to be searched for.
#[derive(Debug, Clone, Default)]
pub(crate) struct Due {
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
pub(crate) struct SearchBuffers {
    /// What is due.
    pub(crate) due: Due,
    /// For each particle whether it is due.
    pub(crate) seeks: Vec<bool>,
    /// What is due and is in no large cluster.
    pub(crate) loose: Vec<u32>,
    /// The particles that a wall reaches: those that each task found.
    pub(crate) reached: Vec<Vec<u32>>,
    /// Of the search for pairs.
    pub(crate) pairs: PairBuffers,
    /// Of the list of spheres of clumps that are near something.
    pub(crate) near: NearBuffers,
    /// Of a look for sleeping bodies beside awake ones.
    pub(crate) awake: AwakeBuffers,
}

/// Vectors of a look for what sleeps beside something awake.
#[derive(Debug, Clone, Default)]
pub(crate) struct AwakeBuffers {
    /// Boxes around those that are awake: those that each task found, and all of them.
    pub(crate) box_tasks: Vec<Vec<Bounds>>,
    pub(crate) boxes: Vec<Bounds>,
    /// The particles at rest beside those: those that each task found, and all of them with riders.
    pub(crate) tasks: Vec<AwakeTask>,
    pub(crate) particles: Vec<u32>,
    /// Balls of these and of awake particles beside them, and for each whether it is awake.
    pub(crate) balls: Vec<Ball>,
    pub(crate) bodies: Vec<u32>,
    /// Of the search among them.
    pub(crate) known: KnownClusters,
    pub(crate) pairs: PairBuffers,
}

/// Vectors of a task that looks for what is at rest beside something awake.
#[derive(Debug, Clone, Default)]
pub(crate) struct AwakeTask {
    /// Numbers of the boxes that reach to the sleepers of its chunk.
    pub(crate) boxes: Vec<u32>,
    pub(crate) particles: Vec<u32>,
}

impl SearchBuffers {
    /// Size of the vectors, bytes.
    pub(crate) fn bytes(&self) -> usize {
        let Self {
            due,
            seeks,
            loose,
            reached,
            pairs,
            near,
            awake,
        } = self;
        let of_due = bytes_of(&due.particles) + bytes_of(&due.clumps);
        let of_walls: usize = reached.iter().map(|some| bytes_of(some)).sum();
        let of_near = bytes_of(&near.bits) + bytes_of(&near.former);
        of_due
            + bytes_of(seeks)
            + bytes_of(loose)
            + of_walls
            + of_near
            + pairs.bytes()
            + awake.bytes()
    }
}

impl PairBuffers {
    fn bytes(&self) -> usize {
        let of_task = |task: &PairTask| {
            let placed = task.placed.iter().map(|boxes| bytes_of(boxes));
            bytes_of(&task.found) + placed.sum::<usize>()
        };
        let of_tasks: usize = self.of_tasks.iter().map(of_task).sum();
        let lists = [&self.of_small, &self.active].map(|some| bytes_of(some));
        let of_balls = bytes_of(&self.small_clusters) + lists.iter().sum::<usize>();
        of_balls + self.grids.bytes() + of_tasks + bytes_of(&self.found)
    }
}

impl AwakeBuffers {
    fn bytes(&self) -> usize {
        let of_boxes: usize = self.box_tasks.iter().map(|some| bytes_of(some)).sum();
        let of_task = |task: &AwakeTask| bytes_of(&task.boxes) + bytes_of(&task.particles);
        let of_tasks: usize = self.tasks.iter().map(of_task).sum();
        let of_search = bytes_of(&self.balls) + bytes_of(&self.bodies) + self.pairs.bytes();
        of_boxes + bytes_of(&self.boxes) + of_tasks + bytes_of(&self.particles) + of_search
    }
}

/// Size of the items of a vector, bytes.
fn bytes_of<T>(all: &[T]) -> usize {
    size_of_val(all)
}

/// Vectors that list which spheres of clumps are near something.
#[derive(Debug, Clone, Default)]
pub(crate) struct NearBuffers {
    /// A bit for each sphere.
    pub(crate) bits: Vec<u64>,
    /// Those that were near before.
    pub(crate) former: Vec<u32>,
}

/// Vectors of a search for pairs.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairBuffers {
    /// Numbers of the small clusters.
    pub(crate) small_clusters: Vec<u32>,
    /// Balls of small clusters that may be in a pair, and their numbers.
    pub(crate) of_small: Vec<(u32, Ball)>,
    /// The balls that may be in a pair with one of a small cluster, and their numbers.
    pub(crate) active: Vec<(u32, Ball)>,
    pub(crate) grids: Grids,
    /// What each task found.
    pub(crate) of_tasks: Vec<PairTask>,
    /// All pairs found.
    pub(crate) found: Vec<[u32; 2]>,
}

/// Vectors of a task that searches for pairs.
#[derive(Debug, Clone, Default)]
pub(crate) struct PairTask {
    pub(crate) found: Vec<[u32; 2]>,
    /// Boxes of each of two clusters in the axes of the other.
    pub(crate) placed: [Vec<BoxColumns>; 2],
}
