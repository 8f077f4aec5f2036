//! A block of space in which the front is processed: its queue, its draws, and its result.

use super::assembly::{Assembly, FrontSphere};
use super::cells::block_of;
use super::draws::{Draws, any_size};
use super::fillers::{BlockFillers, FilledVoids, FillingRules};
use super::places::{Place, Workspace};
use crate::spheres::{ReducedSphere, Vector3, distance};

/// The type of work around the spheres of the front.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Work {
    /// Drawn sizes are placed around spheres up to this distance from their seeds, local units.
    Draws { within: f64 },
    /// Voids are filled, and no size is drawn.
    Voids,
}

/// Rules shared by all blocks that work at the same time.
pub(super) struct Rules<'a> {
    pub(super) work: Work,
    /// Starting points of the fronts, local units.
    pub(super) seeds: &'a [Vector3],
    pub(super) random_seed: u64,
    /// Rules for filling voids, if the front fills them.
    pub(super) filling: Option<FillingRules<'a>>,
}

/// The task of a block.
pub(super) struct Task {
    /// Number of the block.
    pub(super) block: usize,
    pub(super) queue: Vec<FrontSphere>,
    /// A draw that waits for a place.
    pub(super) waiting: Option<f64>,
    /// Its stream of random numbers.
    pub(super) stream: u64,
}

#[derive(Default)]
pub(super) struct BlockResult {
    /// Spheres placed.
    pub(super) placed: Vec<Placed>,
    /// A draw that waits for a place.
    pub(super) waiting: Option<f64>,
    /// Voids filled and left.
    pub(super) filled: FilledVoids,
}

/// A sphere placed.
pub(super) struct Placed {
    pub(super) sphere: FrontSphere,
    /// True if not even the smallest sphere fits around it any more: it need not enter the queue.
    pub(super) is_done: bool,
}

/// A block at work.
pub(super) struct Block<'a> {
    number: usize,
    rules: &'a Rules<'a>,
    /// The front, and the number of its spheres taken so far.
    queue: Vec<FrontSphere>,
    taken: usize,
    draws: Draws,
    /// The fillers of voids, if the front fills them.
    fillers: Option<BlockFillers<'a>>,
    /// Spheres placed by this block: the grid does not hold them yet.
    pub(super) assembled: Vec<ReducedSphere>,
    placed: Vec<Placed>,
}

impl<'a> Block<'a> {
    pub(super) fn new(task: Task, rules: &'a Rules<'a>) -> Self {
        Self {
            number: task.block,
            rules,
            queue: task.queue,
            taken: 0,
            draws: Draws::new(rules.random_seed, task.stream, task.waiting),
            fillers: rules.filling.as_ref().map(BlockFillers::new),
            assembled: Vec::new(),
            placed: Vec::new(),
        }
    }

    /// The next sphere of the front.
    pub(super) fn take(&mut self) -> Option<FrontSphere> {
        let sphere = self.queue.get(self.taken).copied()?;
        self.taken += 1;
        Some(sphere)
    }

    /// A place next to a sphere of the front for the size drawn last; none if it does not fit
    /// there.
    pub(super) fn candidate(
        &mut self,
        assembly: &Assembly,
        workspace: &mut Workspace,
        (initial, number): &FrontSphere,
    ) -> Option<Place> {
        let seed = &self.rules.seeds[*number as usize];
        let assembled = &self.assembled;
        if let Some(fillers) = &mut self.fillers {
            let largest = assembly.settings.radius_range[1];
            assembly.need_neighbours(workspace, initial, assembled, largest);
            return fillers.candidate(
                assembly,
                workspace,
                initial,
                seed,
                assembled,
                &mut self.draws,
            );
        }
        let quantile = self.draws.current(any_size);
        let radius = assembly.radius(quantile);
        if assembly.is_hemmed_in(workspace, initial, assembled, radius) {
            return None;
        }
        assembly.need_neighbours(workspace, initial, assembled, radius);
        let centre = assembly.best_place(workspace, initial, radius, seed)?;
        self.draws.placed();
        Some(Place { centre, quantile })
    }

    /// Adds a new sphere, to the queue as well if it lies in this block and near enough.
    pub(super) fn place(&mut self, assembly: &Assembly, new: FrontSphere, quantile: f64) {
        let (sphere, number) = new;
        self.assembled.push(sphere);
        let is_next = block_of(assembly.grid.lattice(), &sphere).1 == self.number
            && match self.rules.work {
                Work::Draws { within } => {
                    distance(&sphere, &self.rules.seeds[number as usize]) < within
                }
                Work::Voids => false,
            };
        if let Some(fillers) = &mut self.fillers {
            fillers.placed(assembly, &sphere, quantile);
        }
        self.placed.push(Placed {
            sphere: new,
            is_done: is_next && self.fillers.is_some(),
        });
        if is_next {
            self.queue.push(new);
        }
    }

    /// Ends the work around a sphere of the front.
    pub(super) fn retire(&mut self, initial: FrontSphere) {
        if let Some(fillers) = &mut self.fillers {
            fillers.retire(initial);
        }
    }

    pub(super) fn result(self) -> BlockResult {
        BlockResult {
            placed: self.placed,
            waiting: self.draws.waiting,
            filled: self.fillers.map(BlockFillers::filled).unwrap_or_default(),
        }
    }
}
