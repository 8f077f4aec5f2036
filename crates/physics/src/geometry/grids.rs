//! Grids of cells that hold balls: one for each level of size, so that a ball much larger than the
//! others does not make the cells of the others larger.

use std::ops::Range;

use crate::geometry::Bounds;
use crate::geometry::balls::{BOXES, Ball, NOWHERE};

/// Balls of a level are at least half as large as the largest of it, except those of the last.
const MOST_LEVELS: usize = 16;
/// Largest number of cells per ball: a wide, empty scene gets larger cells.
const CELLS_PER_BALL: usize = 4;

/// Grids of all levels, the largest balls first. They are filled again for each search, and keep
/// their memory.
#[derive(Debug, Clone, Default)]
pub struct Grids {
    /// On the heap: contacts, which hold them, are often moved.
    levels: Vec<Grid>,
    largest_m: f64,
}

/// Grid of cells as wide as the largest ball of its level, and the balls in each.
#[derive(Debug, Clone, Default)]
pub struct Grid {
    /// Places of its balls among those given.
    members: Vec<u32>,
    cells: Vec<u32>,
    origin: [f64; 3],
    per_width: f64,
    counts: [usize; 3],
    /// Radius of the largest ball, m.
    largest_m: f64,
    /// For each cell, the first of its balls in `particles`, followed by the total number.
    starts: Vec<u32>,
    /// Numbers of the balls, sorted by cell.
    pub particles: Vec<u32>,
    /// The same balls by columns, x, y, z and radius, m, followed by [`BOXES`] times [`NOWHERE`]:
    /// as many balls can be read from any place.
    pub columns: [Vec<f64>; 4],
}

impl Grids {
    /// Holds these balls, given with their numbers, in place of those before. Their radii are
    /// above 0.
    pub fn fill(&mut self, active: &[(u32, Ball)]) {
        self.levels.resize_with(MOST_LEVELS, Grid::default);
        self.largest_m = active.iter().map(|(_, ball)| ball[3]).fold(0.0, f64::max);
        for level in &mut self.levels {
            level.members.clear();
        }
        for (place, (_, ball)) in (0..).zip(active) {
            let level = self.level_of(ball[3]);
            self.levels[level].members.push(place);
        }
        for level in &mut self.levels {
            level.fill(active);
        }
    }

    /// Size of the vectors, bytes.
    pub fn bytes(&self) -> usize {
        let of_level = |level: &Grid| {
            let numbers = [
                &level.members,
                &level.cells,
                &level.starts,
                &level.particles,
            ];
            let numbers = numbers.iter().map(|some| size_of_val(&some[..]));
            let columns = level.columns.iter().map(|some| size_of_val(&some[..]));
            numbers.sum::<usize>() + columns.sum::<usize>()
        };
        self.levels.iter().map(of_level).sum()
    }

    /// The grids, of the largest balls first.
    #[inline]
    pub fn levels(&self) -> &[Grid] {
        &self.levels[..]
    }

    /// The number of the grid that holds balls of this radius, m.
    #[inline]
    pub fn level_of(&self, radius_m: f64) -> usize {
        // The exponent of a floating-point number is the integer part of its binary logarithm.
        let octaves = ((self.largest_m / radius_m).to_bits() >> 52).saturating_sub(1023);
        (octaves as usize).min(MOST_LEVELS - 1)
    }
}

impl Grid {
    /// Sorts its balls into cells.
    fn fill(&mut self, active: &[(u32, Ball)]) {
        self.particles.clear();
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
        // Their places first, then their numbers.
        self.particles.resize(self.members.len(), 0);
        for (&cell, &given) in cells.iter().zip(&self.members).rev() {
            let place = &mut self.starts[cell as usize];
            *place -= 1;
            self.particles[*place as usize] = given;
        }
        self.cells = cells;
        self.columns.iter_mut().for_each(Vec::clear);
        for number in &mut self.particles {
            let (particle, ball) = active[*number as usize];
            *number = particle;
            for (column, of_ball) in self.columns.iter_mut().zip(ball) {
                column.push(of_ball);
            }
        }
        for (column, nowhere) in self.columns.iter_mut().zip(NOWHERE) {
            column.resize(self.particles.len() + BOXES, nowhere);
        }
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

    #[inline]
    fn cell(&self, ball: Ball) -> [usize; 3] {
        [0, 1, 2].map(|k| {
            let along = (ball[k] - self.origin[k]) * self.per_width;
            (along as usize).min(self.counts[k] - 1)
        })
    }

    #[inline]
    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// The balls in the cells where a ball may overlap some: places in `particles`, one range for
    /// each row of cells.
    #[inline(always)]
    pub fn rows_near(&self, ball: Ball) -> impl Iterator<Item = Range<usize>> {
        let [x, y, z, radius_m] = ball;
        let reach = radius_m + self.largest_m;
        let corner = |side: f64| self.cell([x, y, z, 0.0].map(|c| c + side * reach));
        let (low, high) = (corner(-1.0), corner(1.0));
        let rows = (low[2]..=high[2]).flat_map(move |z| (low[1]..=high[1]).map(move |y| [y, z]));
        rows.map(move |[y, z]| {
            // Neighbouring cells along x are contiguous.
            let [first, last] = [low[0], high[0]].map(|x| self.number([x, y, z]));
            self.starts[first] as usize..self.starts[last + 1] as usize
        })
    }
}
