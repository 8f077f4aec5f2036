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
//! - The queue is worked off in shells around the seeds and, within a shell, in blocks of space in eight colours:
//!   blocks of one colour are too far apart to disturb each other and run on several threads; what comes out does not depend on how many.

use crate::Vector3;
use crate::boundary::{Boundary, Nearest};
use crate::grid::{Ball, Grid};
use crate::halo::{Halo, Neighbours};
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
    /// All spheres in order of placement: centre and reduced radius.
    pub balls: Vec<Ball>,
    /// For each sphere, the number of the seed that its front grew from.
    grew_from: Vec<u32>,
    /// Where fronts began, local units.
    seeds: Vec<Vector3>,
    /// Drawn radii (not reduced) that have found no place yet.
    pub waiting: Vec<f64>,
    streams: u64,
}

/// A sphere and the number of the seed that its front grew from.
type FrontBall = (Ball, u32);

/// Cells along the edge of a block.
const BLOCK: usize = 2;

/// A place at the wall is taken before one that is nearer to the seed by up to this many radii: it fills the first layer at the wall.
const WALL_PREFERENCE: f64 = 0.5;

/// What one block does in its turn.
struct Turn {
    balls: Vec<FrontBall>,
    waiting: Option<f64>,
}

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
        let near_wall = (0..nx * ny * nz)
            .into_par_iter()
            .map(|at| {
                let cell = [at % nx, at / nx % ny, at / (nx * ny)];
                cell.iter()
                    .zip(grid.lattice.counts)
                    .any(|(c, n)| *c == 0 || *c + 1 == n)
                    || !boundary.clears(
                        &grid.lattice.centre(cell),
                        half_diagonal + largest * settings.wall_factor,
                    )
            })
            .collect();
        Self {
            settings,
            boundary,
            grid,
            near_wall,
            balls: Vec::new(),
            grew_from: Vec::new(),
            seeds: Vec::new(),
            waiting: Vec::new(),
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

    /// The three smallest radii (not reduced, ascending) that wait for a place, drawn as far as fewer wait. They wait no longer.
    pub fn next_radii(&mut self) -> [f64; 3] {
        while self.waiting.len() < 3 {
            let mut random = ChaCha8Rng::seed_from_u64(self.settings.seed);
            random.set_stream(self.streams);
            self.streams += 1;
            self.waiting
                .push((self.settings.radius)(random.random::<f64>()));
        }
        self.waiting.sort_unstable_by(|a, b| b.total_cmp(a));
        let mut next = self
            .waiting
            .split_off(self.waiting.len() - 3)
            .into_iter()
            .rev();
        [0; 3].map(|_| next.next().unwrap_or(self.settings.radius_range[0]))
    }

    /// The smallest radius (not reduced) that may be placed next.
    pub fn smallest_next(&self) -> f64 {
        let waiting = self.waiting.iter().copied().fold(f64::INFINITY, f64::min);
        if self.waiting.len() < 3 {
            self.settings.radius_range[0]
        } else {
            waiting
        }
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
        let [smallest, largest] = self.settings.radius_range;
        let room = |p: &Vector3| {
            let wall = self
                .boundary
                .nearest(p, largest)
                .map_or(largest, |near| near.distance);
            wall.min(self.reach_to_spheres(p, largest)).min(largest)
        };
        let roomiest = climb(void, 0.1 * smallest, 1e-3 * smallest, &room);
        let mut random = ChaCha8Rng::seed_from_u64(self.settings.seed);
        random.set_stream(self.streams);
        self.streams += 1;
        // The share of draws that fit, by bisection of the distribution's quantile function.
        let (mut fits, mut fits_not) = (0.0, 1.0);
        for _ in 0..52 {
            let middle = 0.5 * (fits + fits_not);
            if (self.settings.radius)(middle) <= roomiest.radius {
                fits = middle
            } else {
                fits_not = middle
            }
        }
        let radius = (self.settings.radius)(fits * random.random::<f64>());
        if self.fits(&roomiest.centre, radius) {
            (roomiest.centre, radius)
        } else {
            (*void, smallest)
        }
    }

    /// Places that take a sphere of the smallest radius next to the spheres `around` (indices of `balls`).
    pub fn voids(&self, around: &[u32]) -> Vec<Vector3> {
        let smallest = self.settings.radius_range[0];
        around
            .par_iter()
            .with_min_len(256)
            .map_init(Workspace::default, |workspace, i| {
                let ball = self.balls[*i as usize];
                let here = Vector3::new(ball[0], ball[1], ball[2]);
                self.look_around(workspace, &ball, &[], smallest);
                self.best_place(workspace, &ball, smallest, &here)
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
        let lattice = &self.grid.lattice;
        self.near_wall[lattice.index(lattice.cell_of(ball[0], ball[1], ball[2]))]
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
        while let Some((shell, front)) = shells.pop_first() {
            progress(self.balls.len())?;
            let within = f64::from(shell + 1) * self.shell_thickness();
            let mut colours: [BTreeMap<usize, Vec<u32>>; 8] = Default::default();
            for i in front {
                let (colour, block) = self.block_of(&self.balls[i as usize]);
                colours[colour].entry(block).or_default().push(i);
            }
            for blocks in colours {
                if blocks.is_empty() {
                    continue;
                }
                let stream = self.streams;
                self.streams += blocks.len() as u64;
                let tasks: Vec<(usize, Vec<u32>, Option<f64>)> = blocks
                    .into_iter()
                    .map(|(block, queue)| (block, queue, self.waiting.pop()))
                    .collect();
                let turns: Vec<Turn> = tasks
                    .into_par_iter()
                    .enumerate()
                    .map_init(
                        Workspace::default,
                        |workspace, (task, (block, queue, waiting))| {
                            self.advance_block(
                                workspace,
                                within,
                                block,
                                &queue,
                                waiting,
                                stream + task as u64,
                            )
                        },
                    )
                    .collect();
                for turn in turns {
                    self.waiting.extend(turn.waiting);
                    for front_ball in turn.balls {
                        shells
                            .entry(self.shell_of(&front_ball))
                            .or_default()
                            .push(self.balls.len() as u32);
                        self.add(front_ball);
                    }
                }
            }
        }
        Ok(())
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

    /// Works off the front spheres of one block as far as `within` from the seed.
    fn advance_block(
        &self,
        workspace: &mut Workspace,
        within: f64,
        block: usize,
        queue: &[u32],
        mut waiting: Option<f64>,
        stream: u64,
    ) -> Turn {
        let mut random = ChaCha8Rng::seed_from_u64(self.settings.seed);
        random.set_stream(stream);
        let mut draw = || (self.settings.radius)(random.random::<f64>());
        let largest = self.settings.radius_range[1];
        let mut placed: Vec<Ball> = Vec::new();
        let mut balls: Vec<FrontBall> = Vec::new();
        let mut queue: Vec<FrontBall> = queue
            .iter()
            .map(|i| (self.balls[*i as usize], self.grew_from[*i as usize]))
            .collect();
        let mut next = 0;
        while next < queue.len() {
            let (initial, number) = queue[next];
            let seed = &self.seeds[number as usize];
            next += 1;
            self.look_around(workspace, &initial, &placed, largest);
            loop {
                let radius = *waiting.get_or_insert_with(&mut draw);
                let Some(place) = self.best_place(workspace, &initial, radius, seed) else {
                    break;
                };
                waiting = None;
                let ball = [place.x, place.y, place.z, self.reduced(radius)];
                workspace
                    .neighbours
                    .gather(&initial, &[ball], self.reduced(largest));
                workspace.neighbours.sort();
                placed.push(ball);
                balls.push((ball, number));
                if self.block_of(&ball).1 == block && distance(&ball, seed) < within {
                    queue.push((ball, number));
                }
            }
        }
        Turn { balls, waiting }
    }

    /// Collects the spheres and walls that a new sphere of (not reduced) radius up to `largest` on the halo of `front` could touch.
    fn look_around(&self, workspace: &mut Workspace, front: &Ball, placed: &[Ball], largest: f64) {
        let reduced = self.reduced(largest);
        let reach = front[3] + 2.0 * reduced + self.reduced(self.settings.radius_range[1]);
        let neighbours = &mut workspace.neighbours;
        neighbours.clear();
        self.grid.near(front[0], front[1], front[2], reach, |cell| {
            neighbours.gather(front, cell, reduced)
        });
        neighbours.gather(front, placed, reduced);
        neighbours.sort();
        workspace.walls.clear();
        if self.is_near_wall(front) {
            let centre = centre_of(front);
            let reach = front[3] + reduced + self.wall_clearance(largest);
            self.boundary.walls(
                self.boundary.triangles_near(&centre, reach),
                &centre,
                reach,
                &mut workspace.walls,
            );
        }
    }

    /// The place nearest to the seed for a new sphere of (not reduced) `radius` on the halo of `front`.
    fn best_place(
        &self,
        workspace: &mut Workspace,
        front: &Ball,
        radius: f64,
        seed: &Vector3,
    ) -> Option<Vector3> {
        let Workspace {
            neighbours,
            halo,
            walls,
        } = workspace;
        halo.set(front, self.reduced(radius), neighbours);
        let from_seed = halo.centre - seed;
        let mut best: Option<Vector3> = None;
        halo.corners(&from_seed, |centre| {
            let takes = self.clears_wall(centre, radius);
            if takes {
                best = Some(*centre);
            }
            takes
        });
        let order_at = |place: &Vector3| (place - centre_of(front)).dot(&from_seed);
        let mut least = best.as_ref().map_or(f64::INFINITY, order_at);
        for wall in walls.iter() {
            let towards = (wall.point - halo.centre) / wall.distance;
            for j in 0..halo.neighbours() {
                let Some(places) =
                    halo.wall_corners(j, &towards, wall.distance - self.wall_clearance(radius))
                else {
                    continue;
                };
                for p in places {
                    let order =
                        order_at(&halo.position(&p)) - WALL_PREFERENCE * radius * from_seed.norm();
                    if order >= least || !halo.is_free(&p) {
                        continue;
                    }
                    if let Some(centre) = self.touch_wall(halo, radius, j, &p) {
                        (least, best) = (order, Some(centre));
                    }
                }
            }
        }
        best
    }

    /// From a place `p` on the rim of neighbour `j`, near to a place where a sphere of (not reduced) `radius` touches the wall: that place,
    /// if it is free. The wall is taken for a plane at its nearest point, again and again.
    fn touch_wall(&self, halo: &Halo, radius: f64, j: usize, p: &Vector3) -> Option<Vector3> {
        let radius = self.wall_clearance(radius);
        let wanted = radius * (1.0 + 1e-12);
        let mut p = *p;
        for _ in 0..8 {
            let centre = halo.position(&p);
            let near = self.boundary.nearest(&centre, 2.0 * radius)?;
            if near.distance >= radius && near.distance <= radius * (1.0 + 1e-10) {
                return halo.is_free(&p).then_some(centre);
            }
            let towards = (near.point - centre) / near.distance;
            let places = halo.wall_corners(
                j,
                &towards,
                (near.point - halo.centre).dot(&towards) - wanted,
            )?;
            p = if (places[0] - p).norm_squared() < (places[1] - p).norm_squared() {
                places[0]
            } else {
                places[1]
            };
        }
        None
    }
}

/// Arrays that a thread uses again for every front sphere.
#[derive(Default)]
struct Workspace {
    neighbours: Neighbours,
    halo: Halo,
    walls: Vec<Nearest>,
}

fn centre_of(ball: &Ball) -> Vector3 {
    Vector3::new(ball[0], ball[1], ball[2])
}

fn distance(ball: &Ball, point: &Vector3) -> f64 {
    (Vector3::new(ball[0], ball[1], ball[2]) - point).norm()
}
