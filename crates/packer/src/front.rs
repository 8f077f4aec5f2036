//! The advancing front (Lozano et al. 2016; Platzer 2022, algorithm 1; see [`algorithm`]).
//!
//! Front spheres are taken from a queue, nearest to the seed first. Next to a front sphere a new
//! sphere is placed where it touches the front sphere and two neighbours (or one neighbour and the
//! wall), overlaps none and stays inside the surface; of all such places the one nearest to the
//! seed is taken. A front sphere leaves the queue when nothing more fits next to it.
//!
//! Deviations from the sources:
//! - A size that does not fit waits until it does, so that the sizes placed are the sizes drawn.
//! - The front may begin at many seeds at once: each grows outwards, and the directions of growth,
//!   along which a front puts more contacts, average out.
//! - The bare front, which is not settled, fills its voids as it advances (see [`fillers`]).
//! - The queue is worked off in shells around the seeds and, within a shell, in blocks of space in
//!   eight colours: blocks of one colour are too far apart to disturb each other and run on several
//!   threads. The result does not depend on the number of threads.

mod algorithm;
mod assembly;
mod block;
mod cells;
mod draws;
mod fillers;
pub(crate) mod halo;
mod patches;
mod places;
mod quota;
mod rims;
mod voids;

use self::assembly::FrontSphere;
pub(crate) use self::assembly::{Assembly, SizeSettings};
use self::block::{Block, BlockResult, Rules, Task, Work};
use self::cells::by_colour;
pub(crate) use self::draws::first_draw;
use self::fillers::Fillers;
pub(crate) use self::fillers::FillingSettings;
use self::places::Workspace;
pub(crate) use self::quota::SizeQuota;
use crate::spheres::{ReducedSphere, Vector3, distance};
use dem_io::Result;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The queue of the front: the indices of spheres, by the shell around their seed in which they
/// lie.
type Shells = BTreeMap<u32, Vec<u32>>;

/// A packing while it grows.
pub(crate) struct Front<'a> {
    /// The spheres placed.
    pub(crate) assembly: Assembly<'a>,
    /// For each sphere, the number of the seed that its front grew from.
    grew_from: Vec<u32>,
    /// Starting points of the fronts, local units.
    seeds: Vec<Vector3>,
    /// Draws, as quantiles of the radius, that have found no place yet.
    pub(crate) waiting: Vec<f64>,
    /// Seed of the random numbers, and the number of their streams used so far.
    random_seed: u64,
    streams: u64,
    /// The fillers of voids during the front; none before settling.
    fillers: Option<Fillers>,
}

impl<'a> Front<'a> {
    /// A front that has not started.
    pub(crate) fn new(
        assembly: Assembly<'a>,
        random_seed: u64,
        filling: Option<FillingSettings>,
    ) -> Self {
        Self {
            fillers: filling.map(|settings| Fillers::new(settings, &assembly)),
            assembly,
            grew_from: Vec::new(),
            seeds: Vec::new(),
            waiting: Vec::new(),
            random_seed,
            streams: 0,
        }
    }

    /// The three smallest waiting draws (quantiles, ascending), which then wait no longer. New
    /// draws are made if fewer than three wait.
    pub(crate) fn next_draws(&mut self) -> [f64; 3] {
        while self.waiting.len() < 3 {
            self.waiting
                .push(first_draw(self.random_seed, self.streams));
            self.streams += 1;
        }
        self.waiting.sort_unstable_by(|a, b| b.total_cmp(a));
        let mut next = self
            .waiting
            .split_off(self.waiting.len() - 3)
            .into_iter()
            .rev();
        [0; 3].map(|_| next.next().unwrap_or(0.0))
    }

    /// The smallest radius (not reduced) that may be placed next.
    pub(crate) fn smallest_next(&self) -> f64 {
        if self.waiting.len() < 3 || self.fillers.is_some() {
            self.assembly.settings.radius_range[0]
        } else {
            let smallest = self.waiting.iter().copied().fold(1.0, f64::min);
            self.assembly.radius(smallest)
        }
    }

    /// Starts at a seed with spheres that are known to fit, given by centres and (not reduced)
    /// radii. Returns their indices.
    pub(crate) fn begin(
        &mut self,
        seed: &Vector3,
        first: &[(Vector3, f64)],
    ) -> std::ops::Range<u32> {
        let number = self.seeds.len() as u32;
        self.seeds.push(*seed);
        let before = self.assembly.spheres.len() as u32;
        for (centre, radius) in first {
            self.add((self.assembly.sphere(centre, *radius), number));
        }
        before..self.assembly.spheres.len() as u32
    }

    /// Advances the front from the spheres `queue` (indices), until nothing fits next to any of
    /// them or their followers.
    pub(crate) fn advance(
        &mut self,
        queue: &[u32],
        progress: &dyn Fn(usize) -> Result<()>,
    ) -> Result<()> {
        let mut shells = Shells::new();
        for i in queue {
            let shell = self.shell_of(&self.front_sphere(*i));
            shells.entry(shell).or_default().push(*i);
        }
        while !shells.is_empty() {
            while let Some((shell, queue)) = shells.pop_first() {
                progress(self.assembly.spheres.len())?;
                let within = f64::from(shell + 1) * self.shell_thickness();
                let front = queue.into_iter().map(|i| self.front_sphere(i)).collect();
                self.work_off(front, Work::Draws { within }, &mut shells);
                self.fill_voids_behind(shell, &mut shells);
            }
            self.fill_last_voids(&mut shells);
        }
        Ok(())
    }

    /// Processes spheres of the front, colour by colour.
    fn work_off(&mut self, front: Vec<FrontSphere>, work: Work, shells: &mut Shells) {
        for blocks in by_colour(self.assembly.grid.lattice(), front) {
            let mut tasks = self.tasks(blocks, work).into_iter();
            while tasks.len() > 0 {
                let at_once = self.fillers.as_ref().map(Fillers::blocks_at_once);
                let at_once = tasks.by_ref().take(at_once.unwrap_or(usize::MAX)).collect();
                for result in self.work_at_once(at_once, work) {
                    self.merge(result, work, shells);
                }
            }
        }
    }

    /// The tasks of the blocks of one colour.
    fn tasks(&mut self, blocks: BTreeMap<usize, Vec<FrontSphere>>, work: Work) -> Vec<Task> {
        let stream = self.streams;
        self.streams += blocks.len() as u64;
        let task = |((block, queue), stream)| Task {
            block,
            queue,
            waiting: match work {
                Work::Draws { .. } => self.waiting.pop(),
                Work::Voids => None,
            },
            stream,
        };
        blocks.into_iter().zip(stream..).map(task).collect()
    }

    /// Processes blocks in parallel.
    fn work_at_once(&self, tasks: Vec<Task>, work: Work) -> Vec<BlockResult> {
        let front_spheres = tasks.iter().map(|task| task.queue.len()).sum();
        let filling = (self.fillers.as_ref())
            .map(|fillers| fillers.rules(work != Work::Voids, front_spheres));
        let rules = Rules {
            work,
            seeds: &self.seeds,
            random_seed: self.random_seed,
            filling,
        };
        tasks
            .into_par_iter()
            .map_init(Workspace::default, |workspace, task| {
                let mut block = Block::new(task, &rules);
                algorithm::fill(&self.assembly, &mut block, workspace);
                block.result()
            })
            .collect()
    }

    /// Adds the result of a block. Spheres that may still have room next to them are put into their
    /// shells.
    fn merge(&mut self, result: BlockResult, work: Work, shells: &mut Shells) {
        self.waiting.extend(result.waiting);
        for placed in result.placed {
            if !placed.is_done {
                shells
                    .entry(self.shell_of(&placed.sphere))
                    .or_default()
                    .push(self.assembly.spheres.len() as u32);
            }
            self.add(placed.sphere);
        }
        if let Some(mut fillers) = self.fillers.take() {
            fillers.merge(result.filled, work != Work::Voids, |s| self.shell_of(s));
            self.fillers = Some(fillers);
        }
    }

    fn add(&mut self, (sphere, seed): FrontSphere) {
        self.assembly.add(sphere);
        self.grew_from.push(seed);
    }

    fn front_sphere(&self, i: u32) -> FrontSphere {
        (
            self.assembly.spheres[i as usize],
            self.grew_from[i as usize],
        )
    }

    fn shell_of(&self, (sphere, seed): &FrontSphere) -> u32 {
        (distance(sphere, &self.seeds[*seed as usize]) / self.shell_thickness()) as u32
    }

    fn shell_thickness(&self) -> f64 {
        0.5 * self.assembly.grid.lattice().cell
    }
}

/// Methods of a front that fills voids.
impl Front<'_> {
    /// Fills the voids left at least some shells behind `shell`.
    fn fill_voids_behind(&mut self, shell: u32, shells: &mut Shells) {
        while let Some(front) = (self.fillers.as_mut()).and_then(|f| f.next_behind(shell)) {
            self.work_off(front, Work::Voids, shells);
        }
    }

    /// Fills all voids left, as far as small spheres are meanwhile fewer than expected.
    fn fill_last_voids(&mut self, shells: &mut Shells) {
        self.fill_voids_behind(u32::MAX, shells);
        if let Some(fillers) = &mut self.fillers {
            let left_open = std::mem::take(&mut fillers.left_open);
            self.work_off(left_open, Work::Voids, shells);
        }
    }

    /// The sizes placed, if the front fills voids.
    pub(crate) fn quota(&self) -> Option<&SizeQuota> {
        self.fillers.as_ref().map(|fillers| &fillers.quota)
    }

    /// True if voids remain that take the smallest sphere.
    pub(crate) fn has_left_voids(&self) -> bool {
        (self.fillers.as_ref()).is_some_and(|fillers| !fillers.left_open.is_empty())
    }

    /// Ends the front and returns its result.
    pub(crate) fn finish(mut self) -> FinishedFront {
        let spheres = std::mem::take(&mut self.assembly.spheres);
        let mut finished = FinishedFront {
            spheres,
            ..FinishedFront::default()
        };
        if let Some(fillers) = self.fillers {
            finished.fillers = fillers.placed;
            finished.loose_fillers = fillers.loose;
            let open: Vec<ReducedSphere> = fillers.left_open.iter().map(|s| s.0).collect();
            finished.voids_left = self.assembly.count_voids(&open, &fillers.wall_in_reach);
        }
        finished
    }
}

/// The result of a front.
#[derive(Debug, Default)]
pub(crate) struct FinishedFront {
    /// The spheres in order of placement.
    pub(crate) spheres: Vec<ReducedSphere>,
    /// Number of spheres chosen to fill voids.
    pub(crate) fillers: usize,
    /// Number of fillers that touch fewer than three other spheres or walls.
    pub(crate) loose_fillers: usize,
    /// Approximate number of voids that would still take the smallest sphere.
    pub(crate) voids_left: usize,
}
