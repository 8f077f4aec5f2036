//! Spheres sorted by cell, for one search: in one lattice for each size class, so that large
//! spheres do not make the cells of small ones larger.

use std::ops::Range;

use crate::grid::{Lattice, WIDEST_CLASS};
use crate::spheres::ReducedSphere;

/// Largest number of cells of a lattice per sphere.
const MOST_CELLS_PER_SPHERE: f64 = 8.0;

/// Spheres in classes: those larger than half the largest, those larger than half the largest of
/// the rest, and so on.
pub struct SizeClasses {
    skin: f64,
    /// The largest radius of each class and its spheres.
    classes: Vec<(f64, Cells)>,
}

impl SizeClasses {
    /// Sorts spheres for searches up to the distance `skin` (local units) beyond contact.
    pub fn new(balls: &[ReducedSphere], skin: f64) -> Self {
        let mut largest = balls.iter().map(|b| b[3]).fold(0.0, f64::max);
        let smallest = balls.iter().map(|b| b[3]).fold(largest, f64::min);
        let mut classes = Vec::new();
        let mut rest: Vec<u32> = (0..balls.len() as u32).collect();
        while !rest.is_empty() {
            let is_last = largest <= WIDEST_CLASS * smallest;
            let is_smaller = |i: &u32| !is_last && balls[*i as usize][3] < 0.5 * largest;
            let (smaller, members): (Vec<u32>, Vec<u32>) = rest.into_iter().partition(is_smaller);
            if !members.is_empty() {
                // Cells of the largest reach: rows of three hold enough spheres to be compared
                // several at once.
                let cells = Cells::new(balls, &members, 2.0 * largest + skin);
                classes.push((largest, cells));
            }
            rest = smaller;
            largest *= 0.5;
        }
        Self { skin, classes }
    }

    /// Calls `visit` with all spheres less than the skin beyond contact with `ball`, and others.
    #[inline(always)]
    pub fn near(&self, ball: &ReducedSphere, mut visit: impl FnMut(Row)) {
        for (largest, cells) in &self.classes {
            cells.near(ball, ball[3] + largest + self.skin, &mut visit);
        }
    }
}

fn bounds(balls: impl Iterator<Item = ReducedSphere>) -> ([f64; 3], [f64; 3]) {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for ball in balls {
        for k in 0..3 {
            low[k] = low[k].min(ball[k]);
            high[k] = high[k].max(ball[k]);
        }
    }
    (low, high)
}

/// Number of spheres compared at once, and of neighbours processed at once.
pub(super) const LANES: usize = 4;
/// Number of spheres that may be read at once from any sphere of a row on.
pub(super) const AT_ONCE: usize = 8;

/// Spheres of neighbouring cells.
pub struct Row<'a> {
    /// All x, all y, all z, and all reduced radii of all cells, local units.
    pub coordinates: [&'a [f64]; 4],
    /// Their numbers.
    pub numbers: &'a [u32],
    /// Which of them are of the row.
    pub spheres: Range<usize>,
}

/// Spheres sorted by cell (counting sort).
struct Cells {
    lattice: Lattice,
    /// Index of the first sphere of each cell, and the end of the last.
    first: Vec<u32>,
    /// All x, all y, all z, and all radii, followed by [`AT_ONCE`] that stand for none.
    coordinates: [Vec<f64>; 4],
    numbers: Vec<u32>,
}

impl Cells {
    /// The spheres `members` (numbers) of `all`, in cells of at least the edge `cell`.
    fn new(all: &[ReducedSphere], members: &[u32], cell: f64) -> Self {
        let balls = || members.iter().map(|i| all[*i as usize]);
        let (low, high) = bounds(balls());
        // Spheres that fill little of their box would need too many cells: fewer, larger ones are
        // used instead.
        let most = MOST_CELLS_PER_SPHERE * (members.len() as f64 + 1.0);
        let volume: f64 = (0..3).map(|k| (high[k] - low[k]).max(cell)).product();
        let cell = cell.max((volume / most).cbrt());
        let counts = [0, 1, 2].map(|k| ((high[k] - low[k]) / cell) as usize + 1);
        let mut cells = Self {
            lattice: Lattice { low, cell, counts },
            first: vec![0; counts.iter().product::<usize>() + 1],
            coordinates: [0; 4].map(|_| vec![0.0; members.len() + AT_ONCE]),
            numbers: vec![0; members.len() + AT_ONCE],
        };
        let at: Vec<u32> = balls()
            .map(|b| cells.lattice.cell_of(b[0], b[1], b[2]))
            .map(|cell| cells.lattice.index(cell) as u32)
            .collect();
        for a in &at {
            cells.first[*a as usize + 1] += 1;
        }
        for k in 1..cells.first.len() {
            cells.first[k] += cells.first[k - 1];
        }
        let mut next = cells.first.clone();
        for ((ball, i), a) in balls().zip(members).zip(&at) {
            let slot = &mut next[*a as usize];
            for (all, x) in cells.coordinates.iter_mut().zip(ball) {
                all[*slot as usize] = x;
            }
            cells.numbers[*slot as usize] = *i;
            *slot += 1;
        }
        cells
    }

    /// Calls `visit` with the spheres of rows of cells that come within `reach` of the centre of
    /// `ball`.
    #[inline(always)]
    fn near(&self, ball: &ReducedSphere, reach: f64, mut visit: impl FnMut(Row)) {
        self.lattice.rows_near(
            [ball[0], ball[1], ball[2]],
            reach,
            #[inline(always)]
            |row| {
                visit(Row {
                    coordinates: self.coordinates.each_ref().map(Vec::as_slice),
                    numbers: &self.numbers,
                    spheres: self.first[row.start] as usize..self.first[row.end] as usize,
                });
            },
        );
    }
}
