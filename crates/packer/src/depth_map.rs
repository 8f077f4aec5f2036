//! Signed distance to the surface at any point, made cheap by a coarse grid that knows where the surface is far.

use crate::Vector3;
use crate::boundary::Boundary;
use crate::inside::is_inside;
use dem_io::Surface;
use rayon::prelude::*;

/// Cells along the longest edge of the bounding box, at most.
const MOST_CELLS_ALONG: f64 = 100.0;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Cell {
    /// All of it is inside, deeper than the cut-off.
    Deep,
    /// All of it is inside.
    Inside,
    /// All of it is outside.
    Outside,
    /// The surface may pass through it.
    Crossed,
}

/// Knows for the cells of a grid whether they are inside.
pub struct DepthMap<'a> {
    boundary: &'a Boundary,
    cut_off: f64,
    edge: f64,
    counts: [usize; 3],
    cells: Vec<Cell>,
}

impl<'a> DepthMap<'a> {
    /// Prepares distances up to `cut_off` with cells of about `edge` (local units).
    pub fn new(surface: &'a Surface, boundary: &'a Boundary, cut_off: f64, edge: f64) -> Self {
        let extent = surface.extent();
        let edge = edge.max(extent.iter().copied().fold(0.0, f64::max) / MOST_CELLS_ALONG);
        let counts = extent.map(|e| (e / edge) as usize + 1);
        let half_diagonal = 0.5 * 3.0_f64.sqrt() * edge;
        let cells = (0..counts.iter().product::<usize>())
            .into_par_iter()
            .map(|at| {
                let cell = [
                    at % counts[0],
                    at / counts[0] % counts[1],
                    at / (counts[0] * counts[1]),
                ];
                let centre = Vector3::from(cell.map(|c| (c as f64 + 0.5) * edge));
                let distance = boundary
                    .nearest(&centre, cut_off + half_diagonal)
                    .map_or(f64::INFINITY, |near| near.distance);
                if distance <= half_diagonal {
                    Cell::Crossed
                } else if !is_inside(boundary, &centre) {
                    Cell::Outside
                } else if distance > cut_off + half_diagonal {
                    Cell::Deep
                } else {
                    Cell::Inside
                }
            })
            .collect();
        Self {
            boundary,
            cut_off,
            edge,
            counts,
            cells,
        }
    }

    /// Distance to the surface, positive inside, negative outside; infinite where it is more than the cut-off, and anywhere
    /// outside far from the surface.
    pub fn depth(&self, point: [f64; 3]) -> f64 {
        let cell = [0, 1, 2].map(|k| (point[k] / self.edge).floor());
        if (0..3).any(|k| cell[k] < 0.0 || cell[k] >= self.counts[k] as f64) {
            return f64::NEG_INFINITY;
        }
        let [x, y, z] = cell.map(|c| c as usize);
        let point = Vector3::from(point);
        let distance = || {
            self.boundary
                .nearest(&point, self.cut_off)
                .map_or(f64::INFINITY, |near| near.distance)
        };
        match self.cells[(z * self.counts[1] + y) * self.counts[0] + x] {
            Cell::Deep => f64::INFINITY,
            Cell::Inside => distance(),
            Cell::Outside => f64::NEG_INFINITY,
            Cell::Crossed if is_inside(self.boundary, &point) => distance(),
            Cell::Crossed => -distance(),
        }
    }
}
