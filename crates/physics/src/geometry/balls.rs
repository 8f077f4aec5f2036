//! Balls around particles, and boxes around blocks of them.

use nalgebra::Vector3;

use super::Bounds;

/// Centre x, y, z and radius, m.
pub type Ball = [f64; 4];

/// Number of balls, in the order of a cluster, that have a box of their own. Near ones follow one
/// another.
pub const BLOCK: usize = 16;
/// Number of boxes that are compared at once.
pub const BOXES: usize = 8;

/// A ball that overlaps none.
pub const NOWHERE: Ball = [f64::INFINITY, 0.0, 0.0, 0.0];

/// Some boxes by columns: their lower ends along x, y and z, then the upper ones, m.
pub type BoxColumns = [[f64; BOXES]; 6];

/// Boxes around blocks of balls.
#[derive(Debug, Clone)]
pub struct Blocks {
    /// Box around all of them.
    pub bounds: Bounds,
    /// Box around each [`BLOCK`] of balls.
    pub boxes: Vec<Bounds>,
    /// Ball around each of these boxes.
    pub around: Vec<Ball>,
    /// The boxes, [`BOXES`] at once, filled up with empty ones.
    pub columns: Vec<BoxColumns>,
}

impl Default for Blocks {
    fn default() -> Self {
        Self {
            bounds: Bounds::EMPTY,
            boxes: Vec::new(),
            around: Vec::new(),
            columns: Vec::new(),
        }
    }
}

impl Blocks {
    /// The blocks of these balls.
    pub fn of(balls: &[Ball]) -> Self {
        let mut blocks = Self::default();
        let numbers: Vec<u32> = (0..balls.len() as u32).collect();
        blocks.find(&numbers, balls);
        blocks
    }

    /// Makes the boxes around the balls with these numbers.
    pub fn find(&mut self, some: &[u32], balls: &[Ball]) {
        self.boxes.clear();
        self.boxes
            .extend(some.chunks(BLOCK).map(|some| box_of(some, balls)));
        self.around.clear();
        self.around.extend(self.boxes.iter().map(ball_around));
        let boxes = self.boxes.iter();
        self.bounds = boxes.fold(Bounds::EMPTY, |all, one| all.with(one));
        self.columns.clear();
        let columns = |some: &[Bounds]| box_columns(some.iter().copied());
        self.columns.extend(self.boxes.chunks(BOXES).map(columns));
    }
}

/// At most [`BOXES`] boxes by columns, filled up with empty ones.
pub fn box_columns(some: impl Iterator<Item = Bounds>) -> BoxColumns {
    let Bounds { low, high } = Bounds::EMPTY;
    let mut columns = [low[0], low[1], low[2], high[0], high[1], high[2]].map(|c| [c; BOXES]);
    for (n, bounds) in some.enumerate() {
        for k in 0..3 {
            columns[k][n] = bounds.low[k];
            columns[3 + k][n] = bounds.high[k];
        }
    }
    columns
}

/// The box around the balls with these numbers.
pub fn box_of(some: &[u32], balls: &[Ball]) -> Bounds {
    // Four numbers at once, by comparisons that are one operation each: the fourth is not used.
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for &i in some {
        let ball = balls[i as usize];
        for k in 0..4 {
            let (before, after) = (ball[k] - ball[3], ball[k] + ball[3]);
            low[k] = if before < low[k] { before } else { low[k] };
            high[k] = if after > high[k] { after } else { high[k] };
        }
    }
    let ([x0, y0, z0, _], [x1, y1, z1, _]) = (low, high);
    Bounds {
        low: [x0, y0, z0],
        high: [x1, y1, z1],
    }
}

/// The box around a ball.
pub fn around(&[x, y, z, radius_m]: &Ball) -> Bounds {
    Bounds {
        low: [x - radius_m, y - radius_m, z - radius_m],
        high: [x + radius_m, y + radius_m, z + radius_m],
    }
}

/// A ball around a box.
pub fn ball_around(bounds: &Bounds) -> Ball {
    let [low, high] = [bounds.low, bounds.high].map(Vector3::from);
    let centre = 0.5 * (low + high);
    [centre.x, centre.y, centre.z, 0.5 * (high - low).norm()]
}
