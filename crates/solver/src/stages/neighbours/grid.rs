//! Grids of cells that hold balls: one for each level of size, so that a ball much larger than the
//! others does not make the cells of the others larger.

use crate::geometry::Bounds;
use crate::state::balls::Ball;

/// Balls of a level are at least half as large as the largest of it, except those of the last.
const MOST_LEVELS: usize = 16;
/// Largest number of cells per ball: a wide, empty scene gets larger cells.
const CELLS_PER_BALL: usize = 4;

/// Grids of all levels, the largest balls first.
pub(super) struct Grids {
    levels: Vec<Grid>,
    largest_m: f64,
}

/// Grid of cells as wide as the largest ball of its level, and the balls in each.
struct Grid {
    origin: [f64; 3],
    per_width: f64,
    counts: [usize; 3],
    /// Radius of the largest ball, m.
    largest_m: f64,
    /// For each cell, the first of its balls in `standing`, followed by the total number.
    starts: Vec<u32>,
    /// Sorted by cell.
    standing: Vec<Standing>,
}

/// Data of a ball in a cell: a copy, so that the balls of a cell are contiguous in memory.
#[derive(Clone, Copy, Default)]
struct Standing {
    ball: Ball,
    particle: u32,
    cluster: u32,
}

/// A ball whose partners are sought.
#[derive(Clone, Copy)]
pub(super) struct Seeker {
    pub(super) particle: u32,
    pub(super) cluster: u32,
    pub(super) ball: Ball,
}

impl Grids {
    /// These balls, given with their numbers. Their radii are above 0.
    pub(super) fn new(clusters: &[u32], active: &[(u32, Ball)]) -> Self {
        let largest_m = active.iter().map(|(_, ball)| ball[3]).fold(0.0, f64::max);
        let mut of_level = vec![Vec::new(); MOST_LEVELS];
        for &(particle, ball) in active {
            of_level[level_of(ball[3], largest_m)].push(Standing {
                ball,
                particle,
                cluster: clusters[particle as usize],
            });
        }
        let levels = of_level.iter().map(|members| Grid::new(members)).collect();
        Self { levels, largest_m }
    }

    /// Adds the pairs of a ball with the overlapping balls of other clusters, the smaller number
    /// first, in no order. Of two balls that both seek (`seeks` of the number of the other), the
    /// one of the level of smaller balls adds the pair, within a level the one with the smaller
    /// number.
    #[inline]
    pub(super) fn add_pairs(
        &self,
        seeker: &Seeker,
        seeks: impl Fn(u32) -> bool,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        let own = level_of(seeker.ball[3], self.largest_m);
        let i = seeker.particle;
        for (level, grid) in self.levels.iter().enumerate() {
            grid.each_near(seeker, |j| {
                let other_adds = match level.cmp(&own) {
                    std::cmp::Ordering::Less => false,
                    std::cmp::Ordering::Equal => j < i,
                    std::cmp::Ordering::Greater => true,
                };
                if !(other_adds && seeks(j)) {
                    pairs.push([i.min(j), i.max(j)]);
                }
            });
        }
    }

    /// The pairs of a ball as by [`Self::add_pairs`] if all balls seek.
    #[inline]
    pub(super) fn add_pairs_of_all(&self, seeker: &Seeker, pairs: &mut Vec<[u32; 2]>) {
        let own = level_of(seeker.ball[3], self.largest_m);
        let i = seeker.particle;
        for grid in &self.levels[..own] {
            grid.each_near(seeker, |j| pairs.push([i.min(j), i.max(j)]));
        }
        self.levels[own].each_near(seeker, |j| {
            if j > i {
                pairs.push([i, j]);
            }
        });
    }
}

fn level_of(radius_m: f64, largest_m: f64) -> usize {
    let octaves = (largest_m / radius_m).log2();
    (octaves as usize).min(MOST_LEVELS - 1)
}

impl Grid {
    fn new(members: &[Standing]) -> Self {
        let mut grid = Self {
            origin: [0.0; 3],
            per_width: 1.0,
            counts: [0; 3],
            largest_m: 0.0,
            starts: vec![0],
            standing: vec![Standing::default(); members.len()],
        };
        if members.is_empty() {
            return grid;
        }
        let own = || members.iter().map(|standing| standing.ball);
        let bounds = Bounds::of(own().map(|[x, y, z, _]| [x, y, z]));
        grid.largest_m = own().map(|ball| ball[3]).fold(0.0, f64::max);
        let mut width = 2.0 * grid.largest_m;
        let counts_of = |width: f64| {
            [0, 1, 2].map(|k| ((bounds.high[k] - bounds.low[k]) / width).min(1e6) as usize + 1)
        };
        let room = CELLS_PER_BALL * members.len() + 64;
        let product = |counts: [usize; 3]| counts.iter().map(|&n| n as f64).product::<f64>();
        while product(counts_of(width)) > room as f64 {
            width *= 1.25;
        }
        grid.origin = bounds.low;
        grid.per_width = 1.0 / width;
        grid.counts = counts_of(width);
        grid.fill(members);
        grid
    }

    fn fill(&mut self, members: &[Standing]) {
        let cells: Vec<u32> = members
            .iter()
            .map(|standing| self.number(self.cell(standing.ball)) as u32)
            .collect();
        let mut starts = vec![0_u32; self.counts.iter().product::<usize>() + 1];
        for &cell in &cells {
            starts[cell as usize + 1] += 1;
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        for (&cell, standing) in cells.iter().zip(members) {
            let place = &mut next[cell as usize];
            self.standing[*place as usize] = *standing;
            *place += 1;
        }
        self.starts = starts;
    }

    fn cell(&self, ball: Ball) -> [usize; 3] {
        [0, 1, 2].map(|k| {
            let along = (ball[k] - self.origin[k]) * self.per_width;
            (along as usize).min(self.counts[k] - 1)
        })
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// Calls `found` with the number of each ball of another cluster that overlaps the seeker's.
    #[inline(always)]
    fn each_near(&self, seeker: &Seeker, mut found: impl FnMut(u32)) {
        if self.standing.is_empty() {
            return;
        }
        let [px, py, pz, radius_m] = seeker.ball;
        let reach = radius_m + self.largest_m;
        let corner = |side: f64| {
            let [x, y, z, _] = seeker.ball;
            self.cell([x + side * reach, y + side * reach, z + side * reach, 0.0])
        };
        let (low, high) = (corner(-1.0), corner(1.0));
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                // Neighbouring cells along x are contiguous.
                let first = self.starts[self.number([low[0], y, z])] as usize;
                let end = self.starts[self.number([high[0], y, z]) + 1] as usize;
                for other in &self.standing[first..end] {
                    let [ox, oy, oz, other_m] = other.ball;
                    let apart = [ox - px, oy - py, oz - pz];
                    let near = radius_m + other_m;
                    let square = apart[0] * apart[0] + apart[1] * apart[1] + apart[2] * apart[2];
                    if square < near * near && other.cluster != seeker.cluster {
                        found(other.particle);
                    }
                }
            }
        }
    }
}
