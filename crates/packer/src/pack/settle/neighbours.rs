//! Neighbour lists (Verlet lists): the other spheres and triangles of the wall that each sphere
//! could touch, listed from a grid of cells and from the tree of the facets.

use crate::geometry::boundary::Boundary;
use crate::grid::Lattice;
use crate::spheres::{ReducedSphere, Vector3};
use rayon::prelude::*;

/// Largest number of cells of a search per sphere.
const MOST_CELLS_PER_SPHERE: f64 = 8.0;
/// Number of spheres processed by one task.
pub(super) const CHUNK: usize = 1024;

/// The other spheres and the triangles of the wall that each sphere could touch before the lists
/// are rebuilt.
#[derive(Default)]
pub(super) struct NeighbourLists {
    pub(super) spheres: Lists,
    pub(super) walls: Lists,
}

impl NeighbourLists {
    /// Lists, for each of `balls`, the spheres less than `skin` (local units) away from it and the
    /// triangles less than half that away from its radius times `enlarge`: nothing else can touch
    /// it before one sphere has moved by half the skin.
    pub(super) fn new(
        boundary: &Boundary,
        balls: &[ReducedSphere],
        enlarge: f64,
        skin: f64,
    ) -> Self {
        let largest = balls.iter().map(|b| b[3]).fold(0.0, f64::max);
        // Cells of half the largest reach: closer to the shape of a ball than 3 x 3 x 3 cells of
        // the full reach.
        let cells = Cells::new(balls, largest + 0.5 * skin);
        let spheres = lists_of(balls, |i, ball, list| {
            let reach = ball[3] + largest + skin;
            cells.near(ball, reach, |others, numbers| {
                for (other, j) in others.iter().zip(numbers) {
                    let reach = ball[3] + other[3] + skin;
                    if squared_distance(ball, other) < reach * reach && *j as usize != i {
                        list.push(*j);
                    }
                }
            });
        });
        let walls = lists_of(balls, |_, ball, list| {
            let centre = Vector3::new(ball[0], ball[1], ball[2]);
            let reach = ball[3] * enlarge + 0.5 * skin;
            list.extend(
                boundary
                    .triangles_near(&centre, reach)
                    .filter(|t| boundary.nearest_on(*t, &centre).distance < reach),
            );
        });
        Self { spheres, walls }
    }
}

/// A list of numbers for each sphere, one after the other.
#[derive(Default)]
pub(super) struct Lists {
    all: Vec<u32>,
    /// Begin of each list, and end of the last. Spheres + 1.
    first: Vec<u32>,
}

impl Lists {
    pub(super) fn of(&self, sphere: usize) -> &[u32] {
        &self.all[self.first[sphere] as usize..self.first[sphere + 1] as usize]
    }
}

/// For each sphere the list that `fill` makes.
fn lists_of(
    balls: &[ReducedSphere],
    fill: impl Fn(usize, &ReducedSphere, &mut Vec<u32>) + Sync,
) -> Lists {
    let parts: Vec<(Vec<u32>, Vec<u32>)> = balls
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, part)| {
            let (mut list, mut ends) = (
                Vec::with_capacity(part.len() * 16),
                Vec::with_capacity(part.len()),
            );
            for (k, ball) in part.iter().enumerate() {
                fill(chunk * CHUNK + k, ball, &mut list);
                ends.push(list.len() as u32);
            }
            list.shrink_to_fit();
            (list, ends)
        })
        .collect();
    let mut all = Vec::with_capacity(parts.iter().map(|(list, _)| list.len()).sum());
    let mut first = Vec::with_capacity(balls.len() + 1);
    first.push(0);
    for (list, ends) in parts {
        let before = all.len() as u32;
        all.extend(list);
        first.extend(ends.into_iter().map(|e| e + before));
    }
    Lists { all, first }
}

pub(super) fn squared_distance(a: &ReducedSphere, b: &ReducedSphere) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2) + (a[2] - b[2]).powi(2)
}

fn bounds(balls: &[ReducedSphere]) -> ([f64; 3], [f64; 3]) {
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

/// Spheres sorted by cell (counting sort), for one search.
struct Cells {
    lattice: Lattice,
    /// Index of the first sphere of each cell, and the end of the last.
    first: Vec<u32>,
    balls: Vec<ReducedSphere>,
    numbers: Vec<u32>,
}

impl Cells {
    fn new(balls: &[ReducedSphere], cell: f64) -> Self {
        let (low, high) = bounds(balls);
        // Spheres that fill little of their box would need too many cells: fewer, larger ones are
        // used instead.
        let most = MOST_CELLS_PER_SPHERE * (balls.len() as f64 + 1.0);
        let volume: f64 = (0..3).map(|k| (high[k] - low[k]).max(cell)).product();
        let cell = cell.max((volume / most).cbrt());
        let counts = [0, 1, 2].map(|k| ((high[k] - low[k]) / cell) as usize + 1);
        let mut cells = Self {
            lattice: Lattice { low, cell, counts },
            first: vec![0; counts.iter().product::<usize>() + 1],
            balls: vec![[0.0; 4]; balls.len()],
            numbers: vec![0; balls.len()],
        };
        let at: Vec<u32> = balls
            .iter()
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
        for (i, a) in at.iter().enumerate() {
            let slot = &mut next[*a as usize];
            cells.balls[*slot as usize] = balls[i];
            cells.numbers[*slot as usize] = i as u32;
            *slot += 1;
        }
        cells
    }

    /// Calls `visit` with the spheres of rows of cells that come within `reach` of the centre of
    /// `ball`, and their numbers.
    fn near(
        &self,
        ball: &ReducedSphere,
        reach: f64,
        mut visit: impl FnMut(&[ReducedSphere], &[u32]),
    ) {
        self.lattice
            .rows_near([ball[0], ball[1], ball[2]], reach, |row| {
                let spheres = self.first[row.start] as usize..self.first[row.end] as usize;
                visit(&self.balls[spheres.clone()], &self.numbers[spheres]);
            });
    }
}
