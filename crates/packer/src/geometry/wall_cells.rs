//! The triangles of the wall near each cell of a lattice, to find those near many points: one
//! lattice for each size of the surroundings searched, a factor of two apart.

use super::boundary::Boundary;
use crate::grid::Lattice;
use crate::spheres::Vector3;
use rayon::prelude::*;

/// Relative margin for rounding when distances are compared.
const MARGIN: f64 = 1e-9;

/// The wall, sorted for searches around points.
pub struct WallCells<'a> {
    pub(crate) boundary: &'a Boundary,
    /// Largest reach first.
    classes: Vec<ReachClass>,
}

/// Cells for searches up to one distance.
struct ReachClass {
    /// That distance, local units.
    reach: f64,
    lattice: Lattice,
    /// For each cell, the triangles within reach of any of its points, and perhaps others.
    triangles: Vec<Box<[u32]>>,
}

impl<'a> WallCells<'a> {
    /// Sorts the wall for searches from the smallest to the largest distance (local units), into
    /// `most_cells` cells at most for each lattice.
    pub fn new(boundary: &'a Boundary, [smallest, largest]: [f64; 2], most_cells: usize) -> Self {
        let mut reach = largest;
        let mut classes = vec![ReachClass::new(boundary, reach, most_cells)];
        while reach > 2.0 * smallest {
            reach *= 0.5;
            classes.push(ReachClass::new(boundary, reach, most_cells));
        }
        Self { boundary, classes }
    }

    /// The triangles closer to a point than `reach` (local units), which must not exceed the
    /// largest given, in the order of [`Boundary::triangles_near`].
    pub fn near(&self, point: &Vector3, reach: f64) -> impl Iterator<Item = u32> {
        // The last class whose reach is enough. The first is enough for all.
        let class = self
            .classes
            .partition_point(|class| class.reach >= reach)
            .max(1)
            - 1;
        let class = &self.classes[class];
        let [x, y, z] = (*point).into();
        let cell = class.lattice.index(class.lattice.cell_of(x, y, z));
        let is_near = move |t: &u32| self.boundary.is_nearer(*t, point, reach);
        class.triangles[cell].iter().copied().filter(is_near)
    }
}

impl ReachClass {
    fn new(boundary: &Boundary, reach: f64, most_cells: usize) -> Self {
        // Farther outside than this margin nothing is within reach.
        let [low, high] = boundary.bounds();
        let low = low.map(|x| x - reach);
        let extent = [0, 1, 2].map(|k| high[k] + reach - low[k]);
        let mut cell = reach;
        let counts = loop {
            let counts = extent.map(|e| (e / cell) as usize + 1);
            if counts.iter().map(|c| *c as f64).product::<f64>() <= most_cells as f64 {
                break counts;
            }
            cell *= 1.26;
        };
        let lattice = Lattice { low, cell, counts };
        let half_diagonal = 0.5 * 3.0_f64.sqrt() * cell;
        let reach_of_cell = (reach + half_diagonal) * (1.0 + MARGIN);
        let of_cell = |at: usize| {
            let cell = [
                at % counts[0],
                at / counts[0] % counts[1],
                at / (counts[0] * counts[1]),
            ];
            let centre = lattice.centre(cell);
            let triangles = boundary.triangles_near(&centre, reach_of_cell);
            let is_near = |t: &u32| boundary.may_be_nearer(*t, &centre, reach_of_cell);
            triangles.filter(is_near).collect()
        };
        let cells = counts.iter().product::<usize>();
        let triangles = (0..cells).into_par_iter().map(of_cell).collect();
        Self {
            reach,
            lattice,
            triangles,
        }
    }
}
