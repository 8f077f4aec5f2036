//! A cumulative distribution as a monotone table: piecewise cubic, exact to about 1e-9, and quick
//! to invert.

/// Accepted error of one cell, as a fraction of the total.
const TOLERANCE: f64 = 1e-9;
/// Number of cells of the table of starting points for the search for a quantile.
const GUIDE_CELLS: usize = 4096;
/// Nodes and weights of the five-point Gauss-Legendre rule on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.568_888_888_888_888_9),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
    (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
    (0.906_179_845_938_664, 0.236_926_885_056_189_1),
];

/// In `[start, start + width]` the distribution rises from `below` by `fraction`, along the cubic
/// with slope `slope_start` at the start and `slope_end` at the end (both 1 for a straight line; at
/// most 3, so that it is monotone).
#[derive(Debug, Clone)]
struct Cell {
    start: f64,
    width: f64,
    below: f64,
    fraction: f64,
    slope_start: f64,
    slope_end: f64,
}

impl Cell {
    fn rise(&self, t: f64) -> f64 {
        let (a, b) = (self.slope_start, self.slope_end);
        t * (a + t * (3.0 - 2.0 * a - b + t * (a + b - 2.0)))
    }

    fn rise_slope(&self, t: f64) -> f64 {
        let (a, b) = (self.slope_start, self.slope_end);
        a + t * (2.0 * (3.0 - 2.0 * a - b) + t * 3.0 * (a + b - 2.0))
    }

    /// Position in the cell (0 to 1) at which the rise is `wanted` (0 to 1): Newton, kept inside a
    /// bracket.
    fn solve(&self, wanted: f64) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        let mut t = wanted;
        for _ in 0..60 {
            let error = self.rise(t) - wanted;
            if error > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let mut next = t - error / self.rise_slope(t);
            if !(next >= low && next <= high) {
                next = 0.5 * (low + high);
            }
            // The next step would be about the square of this one.
            if (next - t).abs() <= 1e-7 {
                return next;
            }
            t = next;
        }
        t
    }
}

/// A cumulative distribution of diameters. Lengths in the unit of the density from which it was
/// made.
#[derive(Debug, Clone)]
pub struct Curve {
    cells: Vec<Cell>,
    guide: Vec<u32>,
    /// Integral of the density from which it was made.
    pub total: f64,
    /// Mean of the diameter under this distribution.
    pub mean: f64,
}

impl Curve {
    /// A distribution with a single diameter.
    pub(super) fn single(diameter: f64) -> Self {
        let cell = Cell {
            start: diameter,
            width: 0.0,
            below: 0.0,
            fraction: 1.0,
            slope_start: 1.0,
            slope_end: 1.0,
        };
        Self {
            cells: vec![cell],
            guide: vec![0; GUIDE_CELLS],
            total: 1.0,
            mean: diameter,
        }
    }

    /// The distribution whose density in the piece `[knots[i], knots[i + 1]]` is `density(i,
    /// diameter)`: it must be smooth and without a peak much narrower than the piece, but need not
    /// be normalised. None if the total is zero or not finite.
    pub fn from_density(knots: &[f64], density: impl Fn(usize, f64) -> f64) -> Option<Self> {
        let pieces = || {
            knots
                .windows(2)
                .enumerate()
                .filter(|(_, ends)| ends[1] > ends[0])
        };
        let rough: f64 = pieces()
            .map(|(i, ends)| gauss(ends[0], ends[1], &|d| density(i, d)))
            .sum();
        if !(rough.is_finite() && rough > 0.0) {
            return None;
        }
        let mut cells = Vec::new();
        for (i, ends) in pieces() {
            refine(
                ends[0],
                ends[1],
                &|d| density(i, d),
                TOLERANCE * rough,
                50,
                &mut cells,
            );
        }
        let total: f64 = cells.iter().map(|c: &Cell| c.fraction).sum();
        let mut moment = 0.0;
        let mut below = 0.0;
        for cell in &mut cells {
            cell.fraction /= total;
            cell.below = below;
            below += cell.fraction;
            moment += cell.fraction * (cell.start + cell.width * cell.mean_position());
        }
        // Empty cells (a flat part of a sieve curve) are never drawn from and contain no
        // information on the rise.
        let guide = (0..GUIDE_CELLS)
            .map(|g| {
                let u = g as f64 / GUIDE_CELLS as f64;
                cells
                    .partition_point(|c| c.below + c.fraction <= u)
                    .min(cells.len() - 1) as u32
            })
            .collect();
        Some(Self {
            cells,
            guide,
            total,
            mean: moment,
        })
    }

    /// Fraction of the distribution at or below `diameter`.
    pub fn cdf(&self, diameter: f64) -> f64 {
        let last = &self.cells[self.cells.len() - 1];
        if diameter >= last.start + last.width {
            return 1.0;
        }
        let after = self.cells.partition_point(|c| c.start <= diameter);
        let Some(cell) = after.checked_sub(1).map(|i| &self.cells[i]) else {
            return 0.0;
        };
        let t = ((diameter - cell.start) / cell.width).clamp(0.0, 1.0);
        (cell.below + cell.fraction * cell.rise(t)).min(1.0)
    }

    /// The diameter below which the fraction `u` of the distribution lies. `u` outside [0, 1]
    /// counts as the nearer end.
    pub fn quantile(&self, u: f64) -> f64 {
        let u = u.clamp(0.0, 1.0);
        let mut index =
            self.guide[((u * GUIDE_CELLS as f64) as usize).min(GUIDE_CELLS - 1)] as usize;
        while index + 1 < self.cells.len()
            && u >= self.cells[index].below + self.cells[index].fraction
        {
            index += 1;
        }
        let cell = &self.cells[index];
        let wanted = if cell.fraction > 0.0 {
            ((u - cell.below) / cell.fraction).clamp(0.0, 1.0)
        } else {
            1.0
        };
        cell.start + cell.width * cell.solve(wanted)
    }
}

impl Cell {
    /// Mean position (0 to 1) of the content of the cell: one less the integral of the rise.
    fn mean_position(&self) -> f64 {
        0.5 - (self.slope_start - self.slope_end) / 12.0
    }
}

/// Integral of `density` from `from` to `to`, five-point Gauss-Legendre.
fn gauss(from: f64, to: f64, density: &impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    half * GAUSS
        .iter()
        .map(|(x, w)| w * density(middle + half * x))
        .sum::<f64>()
}

/// Divides `[from, to]` until the cubic of each cell follows the integral of the density; appends
/// the cells with their integrals as `fraction`.
fn refine(
    from: f64,
    to: f64,
    density: &impl Fn(f64) -> f64,
    tolerance: f64,
    depth: u32,
    cells: &mut Vec<Cell>,
) {
    let middle = 0.5 * (from + to);
    let whole = gauss(from, to, density);
    let left = gauss(from, middle, density);
    let fraction = left + gauss(middle, to, density);
    let width = to - from;
    let (first, last) = (density(from) * width, density(to) * width);
    let cubic_left = 0.5 * fraction + 0.125 * (first - last);
    let error = (left - cubic_left).abs() + (fraction - whole).abs();
    let steep = first.max(last) > 3.0 * fraction && fraction > tolerance;
    if depth > 0 && (error > tolerance || steep) {
        refine(from, middle, density, tolerance, depth - 1, cells);
        refine(middle, to, density, tolerance, depth - 1, cells);
    } else {
        let slope = |end: f64| {
            if fraction > 0.0 {
                (end / fraction).min(3.0)
            } else {
                1.0
            }
        };
        cells.push(Cell {
            start: from,
            width,
            below: 0.0,
            fraction,
            slope_start: slope(first),
            slope_end: slope(last),
        });
    }
}
