//! Grids of cells that hold balls: one for each level of size, so that a ball much larger than the
//! others does not make the cells of the others larger.

use super::balls::Ball;
use crate::geometry::Bounds;

/// Balls of a level are at least half as large as the largest of it, except those of the last.
const MOST_LEVELS: usize = 16;
/// Largest number of cells per ball: a wide, empty scene gets larger cells.
const CELLS_PER_BALL: usize = 4;

/// Grids of all levels, the largest balls first. They are filled again for each search, and keep
/// their memory.
#[derive(Debug, Clone, Default)]
pub(crate) struct Grids {
    levels: [Grid; MOST_LEVELS],
    largest_m: f64,
}

/// Grid of cells as wide as the largest ball of its level, and the balls in each.
#[derive(Debug, Clone, Default)]
struct Grid {
    /// Places of its balls among those given.
    members: Vec<u32>,
    /// The cell of each.
    cells: Vec<u32>,
    origin: [f64; 3],
    per_width: f64,
    counts: [usize; 3],
    /// Radius of the largest ball, m.
    largest_m: f64,
    /// For each cell, the first of its balls in `standing`, followed by the total number.
    starts: Vec<u32>,
    /// The balls, sorted by cell.
    standing: Vec<Standing>,
}

/// Data of a ball in a cell: a copy, so that the balls of a cell are contiguous in memory.
#[derive(Debug, Clone, Copy, Default)]
struct Standing {
    ball: Ball,
    particle: u32,
    cluster: u32,
}

/// A ball whose partners are sought.
#[derive(Clone, Copy)]
pub(crate) struct Seeker {
    pub(crate) particle: u32,
    pub(crate) cluster: u32,
    pub(crate) ball: Ball,
}

impl Grids {
    /// Holds these balls, given with their numbers, in place of those before. Their radii are
    /// above 0.
    pub(crate) fn fill(&mut self, clusters: &[u32], active: &[(u32, Ball)]) {
        self.largest_m = active.iter().map(|(_, ball)| ball[3]).fold(0.0, f64::max);
        for level in &mut self.levels {
            level.members.clear();
        }
        for (place, (_, ball)) in (0..).zip(active) {
            let level = level_of(ball[3], self.largest_m);
            self.levels[level].members.push(place);
        }
        for level in &mut self.levels {
            level.fill(clusters, active);
        }
    }

    /// Size of the vectors, bytes.
    pub(crate) fn bytes(&self) -> usize {
        let of_level = |level: &Grid| {
            let of_balls = size_of_val(&level.members[..]) + size_of_val(&level.standing[..]);
            of_balls + size_of_val(&level.cells[..]) + size_of_val(&level.starts[..])
        };
        self.levels.iter().map(of_level).sum()
    }

    /// Adds the pairs of a ball with the overlapping balls of other clusters, the smaller number
    /// first, in no order. Of two balls that both seek (`seeks` of the number of the other), the
    /// one of the level of smaller balls adds the pair, within a level the one with the smaller
    /// number.
    #[inline]
    pub(crate) fn add_pairs(
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
    pub(crate) fn add_pairs_of_all(&self, seeker: &Seeker, pairs: &mut Vec<[u32; 2]>) {
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
    /// Sorts its balls into cells.
    fn fill(&mut self, clusters: &[u32], active: &[(u32, Ball)]) {
        self.standing.clear();
        if self.members.is_empty() {
            return;
        }
        self.choose_cells(active);
        let mut cells = std::mem::take(&mut self.cells);
        let cell_of = |&place: &u32| self.number(self.cell(active[place as usize].1)) as u32;
        cells.clear();
        cells.extend(self.members.iter().map(cell_of));
        self.starts.clear();
        self.starts
            .resize(self.counts.iter().product::<usize>() + 1, 0);
        // The end of each cell, from which its start is reached when its balls have been placed.
        for &cell in &cells {
            self.starts[cell as usize] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        self.standing
            .resize(self.members.len(), Standing::default());
        for (&cell, &given) in cells.iter().zip(&self.members).rev() {
            let place = &mut self.starts[cell as usize];
            *place -= 1;
            let (particle, ball) = active[given as usize];
            self.standing[*place as usize] = Standing {
                ball,
                particle,
                cluster: clusters[particle as usize],
            };
        }
        self.cells = cells;
    }

    /// Sets the width of its cells, and where they are.
    fn choose_cells(&mut self, active: &[(u32, Ball)]) {
        let own = || self.members.iter().map(|&place| active[place as usize].1);
        let bounds = Bounds::of(own().map(|[x, y, z, _]| [x, y, z]));
        self.largest_m = own().map(|ball| ball[3]).fold(0.0, f64::max);
        let mut width = 2.0 * self.largest_m;
        let counts_of = |width: f64| {
            [0, 1, 2].map(|k| ((bounds.high[k] - bounds.low[k]) / width).min(1e6) as usize + 1)
        };
        let room = CELLS_PER_BALL * self.members.len() + 64;
        let product = |counts: [usize; 3]| counts.iter().map(|&n| n as f64).product::<f64>();
        while product(counts_of(width)) > room as f64 {
            width *= 1.25;
        }
        self.origin = bounds.low;
        self.per_width = 1.0 / width;
        self.counts = counts_of(width);
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
