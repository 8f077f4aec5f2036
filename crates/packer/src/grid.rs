//! Dense grids of cells over a box, one for each size class, to find the spheres near a point.

use crate::spheres::{ReducedSphere, Vector3};
use std::ops::Range;

/// Ratio of sizes from which on the smaller ones have cells of their own.
pub(crate) const WIDEST_CLASS: f64 = 5.0;
/// Edge of a cell, in largest radii of its size class.
const CELL: f64 = 4.0;

/// Equal cubic cells over a box, numbered along x first.
pub(crate) struct Lattice {
    /// Smallest corner of the box, local units. Length 3.
    pub low: [f64; 3],
    /// Edge of a cell, local units.
    pub cell: f64,
    /// Number of cells along x, y, z.
    pub counts: [usize; 3],
}

impl Lattice {
    /// The cell of a point along each axis; points outside belong to the outermost cells.
    #[inline(always)]
    pub(crate) fn cell_of(&self, x: f64, y: f64, z: f64) -> [usize; 3] {
        let along = |k: usize, x: f64| {
            (((x - self.low[k]) / self.cell).max(0.0) as usize).min(self.counts[k] - 1)
        };
        [along(0, x), along(1, y), along(2, z)]
    }

    /// Number of a cell.
    pub(crate) fn index(&self, cell: [usize; 3]) -> usize {
        (cell[2] * self.counts[1] + cell[1]) * self.counts[0] + cell[0]
    }

    /// Centre of a cell, local units.
    pub(crate) fn centre(&self, cell: [usize; 3]) -> Vector3 {
        Vector3::from([0, 1, 2].map(|k| self.low[k] + (cell[k] as f64 + 0.5) * self.cell))
    }

    /// Calls `visit` with the numbers of each row of cells that a cube of half edge `reach` around
    /// the point touches.
    #[inline(always)]
    pub(crate) fn rows_near(
        &self,
        [x, y, z]: [f64; 3],
        reach: f64,
        mut visit: impl FnMut(Range<usize>),
    ) {
        let first = self.cell_of(x - reach, y - reach, z - reach);
        let last = self.cell_of(x + reach, y + reach, z + reach);
        for k in first[2]..=last[2] {
            for j in first[1]..=last[1] {
                let row = self.index([0, j, k]);
                visit(row + first[0]..row + last[0] + 1);
            }
        }
    }
}

/// Spheres sorted into cubic cells: in a lattice for each size class, so that the cells of small
/// spheres are small. Lengths in local units.
pub struct Grid {
    /// Largest spheres first.
    classes: Vec<SizeClass>,
}

/// Spheres larger than half the largest, or all smaller ones as well.
struct SizeClass {
    largest: f64,
    lattice: Lattice,
    cells: Vec<Vec<ReducedSphere>>,
}

impl SizeClass {
    fn new(low: &Vector3, high: &Vector3, largest: f64, most_cells: usize) -> Self {
        let mut cell = CELL * largest;
        loop {
            let counts = [0, 1, 2].map(|k| (((high[k] - low[k]) / cell).floor() as usize) + 1);
            if counts.iter().map(|c| *c as f64).product::<f64>() <= most_cells as f64 {
                let low = (*low).into();
                return Self {
                    largest,
                    lattice: Lattice { low, cell, counts },
                    cells: vec![Vec::new(); counts.iter().product()],
                };
            }
            cell *= 1.26;
        }
    }
}

impl Grid {
    /// An empty grid over the box from `low` to `high` for spheres of radii from `smallest` to
    /// `largest`. Cells grow where the box would need more than `most_cells` of them.
    pub fn new(
        low: &Vector3,
        high: &Vector3,
        [smallest, largest]: [f64; 2],
        most_cells: usize,
    ) -> Self {
        let mut class = largest;
        let mut classes = vec![SizeClass::new(low, high, class, most_cells)];
        while class > WIDEST_CLASS * smallest {
            class *= 0.5;
            classes.push(SizeClass::new(low, high, class, most_cells));
        }
        Self { classes }
    }

    /// The cells of the largest spheres.
    pub(crate) fn lattice(&self) -> &Lattice {
        &self.classes[0].lattice
    }

    /// Adds a sphere.
    pub fn insert(&mut self, ball: ReducedSphere) {
        let class = self
            .classes
            .iter()
            .rposition(|class| ball[3] <= class.largest);
        let class = &mut self.classes[class.unwrap_or(0)];
        let cell = class.lattice.cell_of(ball[0], ball[1], ball[2]);
        class.cells[class.lattice.index(cell)].push(ball);
    }

    /// Calls `visit` with the spheres of each cell that may hold one whose surface is within `gap`
    /// of the point.
    pub fn near(&self, point: [f64; 3], gap: f64, mut visit: impl FnMut(&[ReducedSphere])) {
        for class in &self.classes {
            class.lattice.rows_near(point, gap + class.largest, |row| {
                for cell in &class.cells[row] {
                    visit(cell);
                }
            });
        }
    }
}

/// The position of a point along a curve through all cells of this edge (their Morton codes):
/// points near each other in this order are near each other in space.
pub(crate) fn curve_position(point: [f64; 3], edge: f64) -> u64 {
    let cell = point.map(|x| (x / edge).clamp(0.0, 2_097_151.0) as u64);
    spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
}

/// The 21 lowest bits of `x`, two zeros between each and the next.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}
