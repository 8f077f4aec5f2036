//! The advancing front (Lozano 2016; Platzer 2022, algorithm 1).
//!
//! Front spheres are taken from a queue, nearest to the seed first. Around the front sphere a new sphere is placed
//! where it touches the front sphere and two neighbours (or one neighbour and the wall), overlaps none and stays inside the surface;
//! of all such places the one nearest to the seed is taken. A front sphere around which nothing fits any more leaves the queue.
//!
//! Deviations from the sources:
//! - A radius that does not fit waits until it does, so that the radii placed are the radii drawn.
//! - The front may begin at many seeds at once: each grows outwards, and the directions of growth, along which a front puts
//!   more contacts, average out.
//! - Where a front sphere would leave the queue although a smaller sphere than the one drawn fits around it, about the largest that fits is
//!   placed, and its size is drawn less often afterwards (see ledger.rs): so no void is left that takes the smallest sphere, and the radii
//!   placed still follow the distribution. Not before settling, which moves the spheres anyway.
//! - The queue is worked off in shells around the seeds and, within a shell, in blocks of space in eight colours:
//!   blocks of one colour are too far apart to disturb each other and run on several threads; what comes out does not depend on how many.

mod places;
mod turn;

use self::places::Workspace;
use self::turn::{Rules, Task, Turn};
use crate::Vector3;
use crate::boundary::Boundary;
use crate::grid::{Ball, Grid};
use crate::ledger::Ledger;
use crate::seed::climb;
use dem_io::Result;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// What the front needs to know. Lengths in local units.
pub struct FrontSettings<'a> {
    /// Radius (not reduced) from a uniform random number in [0, 1).
    pub radius: &'a (dyn Fn(f64) -> f64 + Sync),
    /// Smallest and largest radius that `radius` can give.
    pub radius_range: [f64; 2],
    /// Reduced radius = radius / (1 + overlap).
    pub overlap: f64,
    /// A sphere keeps its radius times this clear of the wall: more than 1 if it is to grow later.
    pub wall_factor: f64,
    /// Cells of the grid at most: for shapes that fill little of their box.
    pub most_cells: usize,
    /// Spheres expected, about.
    pub expected: f64,
    /// Where a radius drawn does not fit but a smaller one does, a smaller one is placed, and a later draw of its size left out.
    pub fills_voids: bool,
    /// As long as small spheres are not more than expected by this many roots of the number of spheres, voids are filled at all.
    pub most_too_many: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// A packing while it grows.
pub struct Front<'a> {
    /// As given to `new`.
    pub settings: FrontSettings<'a>,
    boundary: &'a Boundary,
    grid: Grid,
    /// Cells that a sphere may have its centre in only after a distance query.
    near_wall: Vec<bool>,
    /// Cells in which a sphere may have neighbours that touch the wall.
    wall_in_reach: Vec<bool>,
    /// All spheres in order of placement: centre and reduced radius.
    pub balls: Vec<Ball>,
    /// For each sphere, the number of the seed that its front grew from.
    grew_from: Vec<u32>,
    /// Where fronts began, local units.
    seeds: Vec<Vector3>,
    /// Draws, as quantiles of the radius, that have found no place yet.
    pub waiting: Vec<f64>,
    /// Sizes placed out of turn.
    pub ledger: Ledger,
    /// Spheres that left the queue with room around them for the smallest sphere, by shell.
    with_room: BTreeMap<u32, Vec<FrontBall>>,
    /// Those of them around which voids had to be left.
    left_open: Vec<FrontBall>,
    /// Spheres that were chosen to fill voids.
    pub fillers: usize,
    /// Those of them that touch no three others or walls.
    pub loose: usize,
    streams: u64,
}

/// A sphere and the number of the seed that its front grew from.
type FrontBall = (Ball, u32);

/// As long as small spheres are not more than expected by this many roots of the number of spheres (a fifth of what chance does), voids are
/// filled at once. Others wait until the front is `LAG` shells farther: draws that were made meanwhile may have filled them.
const MOST_AT_ONCE: f64 = 0.27;
const LAG: u32 = 3;
/// Voids filled in a block, about: of some 70 spheres one in eight fills a void.
const FILLERS_OF_BLOCK: f64 = 10.0;
/// Voids are counted up to this number, and extrapolated from there.
const MOST_COUNTED: usize = 10_000;

/// Cells along the edge of a block.
const BLOCK: usize = 2;

impl<'a> Front<'a> {
    /// An empty packing in the box up to `extent`.
    pub fn new(settings: FrontSettings<'a>, boundary: &'a Boundary, extent: &Vector3) -> Self {
        let largest = settings.radius_range[1];
        let reduced = largest / (1.0 + settings.overlap);
        let grid = Grid::new(
            &Vector3::zeros(),
            extent,
            4.0 * reduced,
            settings.most_cells,
        );
        let half_diagonal = 0.5 * 3.0_f64.sqrt() * grid.lattice.cell;
        let [nx, ny, nz] = grid.lattice.counts;
        let cells_near_wall = |distance: f64| {
            (0..nx * ny * nz)
                .into_par_iter()
                .map(|at| {
                    let cell = [at % nx, at / nx % ny, at / (nx * ny)];
                    cell.iter()
                        .zip(grid.lattice.counts)
                        .any(|(c, n)| *c == 0 || *c + 1 == n)
                        || !boundary.clears(&grid.lattice.centre(cell), half_diagonal + distance)
                })
                .collect()
        };
        let near_wall = cells_near_wall(largest * settings.wall_factor);
        let wall_in_reach = if settings.fills_voids {
            cells_near_wall(2.0 * reduced + largest * settings.wall_factor)
        } else {
            Vec::new()
        };
        let ledger = Ledger::new(settings.expected);
        Self {
            settings,
            boundary,
            grid,
            near_wall,
            wall_in_reach,
            balls: Vec::new(),
            grew_from: Vec::new(),
            seeds: Vec::new(),
            waiting: Vec::new(),
            ledger,
            with_room: BTreeMap::new(),
            left_open: Vec::new(),
            fillers: 0,
            loose: 0,
            streams: 0,
        }
    }

    /// Adds spheres that are there already: centre and reduced radius.
    pub fn adopt(&mut self, balls: &[Ball]) {
        for ball in balls {
            self.grid.insert(*ball);
        }
        self.balls.extend_from_slice(balls);
        self.grew_from.resize(self.balls.len(), 0);
    }

    /// The three smallest draws (quantiles, ascending) that wait for a place, made as far as fewer wait. They wait no longer.
    pub fn next_draws(&mut self) -> [f64; 3] {
        while self.waiting.len() < 3 {
            let mut random = ChaCha8Rng::seed_from_u64(self.settings.seed);
            random.set_stream(self.streams);
            self.streams += 1;
            self.waiting.push(random.random::<f64>());
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
    pub fn smallest_next(&self) -> f64 {
        if self.waiting.len() < 3 || self.settings.fills_voids {
            self.settings.radius_range[0]
        } else {
            self.radius(self.waiting.iter().copied().fold(1.0, f64::min))
        }
    }

    /// Radius (not reduced) of a quantile.
    pub fn radius(&self, u: f64) -> f64 {
        (self.settings.radius)(u)
    }

    /// Distance from a point to the nearest sphere's surface (reduced radius), at most `cut_off`, local units.
    pub fn gap(&self, point: &Vector3, cut_off: f64) -> f64 {
        let largest = self.reduced(self.settings.radius_range[1]);
        let mut gap = cut_off;
        self.grid
            .near(point.x, point.y, point.z, cut_off + largest, |cell| {
                for ball in cell {
                    gap = gap.min(distance(ball, point) - ball[3]);
                }
            });
        gap
    }

    /// Whether a sphere of this (not reduced) radius with its centre here, known to be inside the solid, overlaps neither sphere nor wall.
    pub fn fits(&self, centre: &Vector3, radius: f64) -> bool {
        let reduced = self.reduced(radius);
        self.gap(centre, 1.001 * reduced) >= reduced * (1.0 - 1e-12)
            && self.boundary.clears(centre, self.wall_clearance(radius))
    }

    /// Radius (not reduced) of the largest sphere around `point` that overlaps no other, at most `cut_off`, local units.
    pub fn reach_to_spheres(&self, point: &Vector3, cut_off: f64) -> f64 {
        self.gap(point, cut_off) * (1.0 + self.settings.overlap)
    }

    /// The roomiest place near a void (where the smallest sphere fits), and a radius (not reduced) drawn among those that fit there.
    pub fn fill(&mut self, void: &Vector3) -> (Vector3, f64) {
        let smallest = self.settings.radius_range[0];
        let roomiest = climb(void, 0.1 * smallest, 1e-3 * smallest, &|p| self.room(p));
        let mut random = ChaCha8Rng::seed_from_u64(self.settings.seed);
        random.set_stream(self.streams);
        self.streams += 1;
        let fits = self.largest_quantile_below(roomiest.radius);
        let radius = self.radius(fits * random.random::<f64>());
        if self.fits(&roomiest.centre, radius) {
            (roomiest.centre, radius)
        } else {
            (*void, smallest)
        }
    }

    /// Radius (not reduced) of the largest sphere around a place that overlaps neither sphere nor wall, at most the largest asked for.
    fn room(&self, place: &Vector3) -> f64 {
        let largest = self.settings.radius_range[1];
        let wall = self
            .boundary
            .nearest(place, largest)
            .map_or(largest, |near| near.distance);
        wall.min(self.reach_to_spheres(place, largest)).min(largest)
    }

    /// The share of draws whose radius is at most this.
    fn largest_quantile_below(&self, radius: f64) -> f64 {
        let (mut fits, mut fits_not) = (0.0, 1.0);
        for _ in 0..52 {
            let middle = 0.5 * (fits + fits_not);
            if self.radius(middle) <= radius {
                fits = middle
            } else {
                fits_not = middle
            }
        }
        fits
    }

    /// Places that take a sphere of the smallest radius next to the spheres `around` (indices of `balls`).
    pub fn voids(&self, around: &[u32]) -> Vec<Vector3> {
        let smallest = self.settings.radius_range[0];
        around
            .par_iter()
            .with_min_len(256)
            .map_init(Workspace::default, |workspace, i| {
                let ball = self.balls[*i as usize];
                self.look_around(workspace, &ball, &[], smallest);
                self.best_place(workspace, &ball, smallest, &centre_of(&ball))
            })
            .flatten_iter()
            .collect()
    }

    /// Adds a sphere of this (not reduced) radius where it is known to fit.
    pub fn place(&mut self, centre: &Vector3, radius: f64) {
        let ball = [centre.x, centre.y, centre.z, self.reduced(radius)];
        self.add((ball, self.seeds.len().saturating_sub(1) as u32));
    }

    /// Names the place that the spheres placed from now on grow from.
    pub fn begin(&mut self, seed: &Vector3) {
        self.seeds.push(*seed);
    }

    /// The part of a (not reduced) radius within which spheres do not overlap.
    pub fn reduced(&self, radius: f64) -> f64 {
        radius / (1.0 + self.settings.overlap)
    }

    /// Whether a sphere of this (not reduced) radius lies inside the surface, given that its centre does not lie beyond it.
    fn clears_wall(&self, centre: &Vector3, radius: f64) -> bool {
        !self.is_near_wall(&[centre.x, centre.y, centre.z, 0.0])
            || self.boundary.clears(centre, self.wall_clearance(radius))
    }

    /// How far from the wall the centre of a sphere of this (not reduced) radius must be.
    fn wall_clearance(&self, radius: f64) -> f64 {
        radius * self.settings.wall_factor
    }

    /// Whether the cell that the ball's centre lies in is near the wall.
    fn is_near_wall(&self, ball: &Ball) -> bool {
        self.is_near(&self.near_wall, ball)
    }

    /// What `cells` says of the cell that the ball's centre lies in.
    fn is_near(&self, cells: &[bool], ball: &Ball) -> bool {
        let lattice = &self.grid.lattice;
        cells[lattice.index(lattice.cell_of(ball[0], ball[1], ball[2]))]
    }

    /// Advances the front from the spheres `queue` (indices of `balls`), until nothing fits around any of them and their followers.
    ///
    /// # Errors
    /// What `progress` returns.
    pub fn advance(&mut self, queue: &[u32], progress: &dyn Fn(usize) -> Result<()>) -> Result<()> {
        let mut shells: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for i in queue {
            let shell = self.shell_of(&(self.balls[*i as usize], self.grew_from[*i as usize]));
            shells.entry(shell).or_default().push(*i);
        }
        while !shells.is_empty() {
            while let Some((shell, front)) = shells.pop_first() {
                progress(self.balls.len())?;
                let within = f64::from(shell + 1) * self.shell_thickness();
                let front = front.into_iter().map(|i| {
                    let i = i as usize;
                    (self.balls[i], self.grew_from[i])
                });
                self.work_off(front.collect(), Some(within), &mut shells);
                self.fill_voids_behind(shell, &mut shells);
            }
            self.fill_voids_behind(u32::MAX, &mut shells);
            // Small spheres may have become fewer than expected meanwhile.
            let left_open = std::mem::take(&mut self.left_open);
            self.work_off(left_open, None, &mut shells);
        }
        Ok(())
    }

    /// Fills the voids that were left `LAG` shells and more behind `shell`.
    fn fill_voids_behind(&mut self, shell: u32, shells: &mut BTreeMap<u32, Vec<u32>>) {
        while let Some(entry) = self.with_room.first_entry() {
            if *entry.key() > shell.saturating_sub(LAG) {
                break;
            }
            let front = entry.remove();
            self.work_off(front, None, shells);
        }
    }

    /// Works off spheres of the front: with draws as far as `within` from the seeds, or filling voids only.
    fn work_off(
        &mut self,
        front: Vec<FrontBall>,
        within: Option<f64>,
        shells: &mut BTreeMap<u32, Vec<u32>>,
    ) {
        let mut colours: [BTreeMap<usize, Vec<FrontBall>>; 8] = Default::default();
        for front_ball in front {
            let (colour, block) = self.block_of(&front_ball.0);
            colours[colour].entry(block).or_default().push(front_ball);
        }
        for blocks in colours {
            if blocks.is_empty() {
                continue;
            }
            let stream = self.streams;
            self.streams += blocks.len() as u64;
            let tasks: Vec<Task> = blocks
                .into_iter()
                .zip(stream..)
                .map(|((block, queue), stream)| Task {
                    block,
                    queue,
                    waiting: within.and_then(|_| self.waiting.pop()),
                    stream,
                })
                .collect();
            let mut tasks = tasks.into_iter();
            while tasks.len() > 0 {
                let tasks: Vec<Task> = tasks.by_ref().take(self.blocks_at_once()).collect();
                let draws = tasks.iter().map(|task| task.queue.len()).sum();
                let most_too_many = match within {
                    Some(_) => MOST_AT_ONCE,
                    None => self.settings.most_too_many,
                };
                let rules = Rules {
                    within,
                    left_out: &self.ledger.shares_left_out(draws),
                    fills: self.fillers_allowed(most_too_many) > 0.0,
                };
                let turns: Vec<Turn> = tasks
                    .into_par_iter()
                    .map_init(Workspace::default, |workspace, task| {
                        self.advance_block(workspace, task, &rules)
                    })
                    .collect();
                for turn in turns {
                    self.take(turn, within.is_some(), shells);
                }
            }
        }
    }

    /// How many more voids may be filled if there may be so many roots of the number of spheres too many small ones.
    fn fillers_allowed(&self, most_too_many: f64) -> f64 {
        most_too_many * self.settings.expected.sqrt() - self.ledger.too_many()
    }

    /// How many blocks may take a turn until the next look at the ledger: no more than fill the voids that may be filled at all.
    fn blocks_at_once(&self) -> usize {
        let allowed = self.fillers_allowed(self.settings.most_too_many);
        if self.settings.fills_voids && allowed > 0.0 {
            (allowed / FILLERS_OF_BLOCK).ceil() as usize
        } else {
            usize::MAX
        }
    }

    /// Adds what a block did in its turn; spheres around which there may be room are put into their shells.
    fn take(&mut self, turn: Turn, draws: bool, shells: &mut BTreeMap<u32, Vec<u32>>) {
        self.waiting.extend(turn.waiting);
        for placed in turn.placed {
            if !placed.is_done {
                shells
                    .entry(self.shell_of(&placed.ball))
                    .or_default()
                    .push(self.balls.len() as u32);
            }
            self.add(placed.ball);
        }
        for front_ball in turn.with_room {
            if draws {
                let shell = self.shell_of(&front_ball);
                self.with_room.entry(shell).or_default().push(front_ball);
            } else {
                self.left_open.push(front_ball);
            }
        }
        turn.quantiles.iter().for_each(|u| self.ledger.place(*u));
        self.fillers += turn.fillers;
        self.loose += turn.loose;
    }

    /// Whether voids were left that take the smallest sphere.
    pub fn has_left_voids(&self) -> bool {
        !self.left_open.is_empty()
    }

    /// About how many more of the smallest spheres would fit around the spheres around which voids had to be left.
    pub fn voids_left(mut self) -> usize {
        let open = std::mem::take(&mut self.left_open);
        let mut workspace = Workspace::default();
        let smallest = self.settings.radius_range[0];
        let mut found = 0;
        // In strides, so that what is found first is spread evenly.
        let stride = open.len().div_ceil(100).max(1);
        let spread = (0..stride).flat_map(|first| open.iter().skip(first).step_by(stride));
        for (searched, (ball, _)) in spread.enumerate() {
            if found >= MOST_COUNTED {
                return found * open.len() / searched;
            }
            loop {
                self.look_around(&mut workspace, ball, &[], smallest);
                let Some(place) = self.place_for_smallest(&mut workspace, ball) else {
                    break;
                };
                self.grid
                    .insert([place.x, place.y, place.z, self.reduced(smallest)]);
                found += 1;
            }
        }
        found
    }

    /// About how many of the smallest spheres would fit around all spheres.
    pub fn count_voids(mut self) -> usize {
        self.left_open = self.balls.iter().map(|ball| (*ball, 0)).collect();
        self.voids_left()
    }

    fn add(&mut self, (ball, seed): FrontBall) {
        self.grid.insert(ball);
        self.balls.push(ball);
        self.grew_from.push(seed);
    }

    fn shell_of(&self, (ball, seed): &FrontBall) -> u32 {
        (distance(ball, &self.seeds[*seed as usize]) / self.shell_thickness()) as u32
    }

    fn shell_thickness(&self) -> f64 {
        0.5 * self.grid.lattice.cell
    }

    /// Colour and number of the block that a sphere's centre lies in.
    fn block_of(&self, ball: &Ball) -> (usize, usize) {
        let block = self
            .grid
            .lattice
            .cell_of(ball[0], ball[1], ball[2])
            .map(|c| c / BLOCK);
        let colour = block[0] % 2 + 2 * (block[1] % 2) + 4 * (block[2] % 2);
        (colour, self.grid.lattice.index(block))
    }
}

fn centre_of(ball: &Ball) -> Vector3 {
    Vector3::new(ball[0], ball[1], ball[2])
}

fn distance(ball: &Ball, point: &Vector3) -> f64 {
    (centre_of(ball) - point).norm()
}
