//! The spheres placed so far (the source's assemblyList and grid), and the room that they and the
//! wall leave.

use crate::geometry::boundary::Boundary;
use crate::grid::Grid;
use crate::spheres::{ReducedSphere, Vector3, distance};
use rayon::prelude::*;

/// The sizes to be placed, and their distances from each other and from the wall. Lengths in local
/// units.
pub(crate) struct SizeSettings<'a> {
    /// Radius (not reduced) from a uniform random number in [0, 1).
    pub(crate) radius: Box<dyn Fn(f64) -> f64 + Sync + 'a>,
    /// Smallest and largest radius that `radius` can give.
    pub(crate) radius_range: [f64; 2],
    /// Reduced radius = radius / (1 + overlap).
    pub(crate) overlap: f64,
    /// Distance that a sphere keeps from the wall / its radius: more than 1 if it is to grow later.
    pub(crate) wall_factor: f64,
    /// Largest number of cells of the grid: a limit for shapes that fill little of their box.
    pub(crate) most_cells: usize,
}

/// A sphere of the front, and the index of the seed from which its front grew.
pub(crate) type FrontSphere = (ReducedSphere, u32);

/// Spheres inside a solid, in a grid of cells.
pub(crate) struct Assembly<'a> {
    pub(crate) settings: SizeSettings<'a>,
    pub(super) boundary: &'a Boundary,
    pub(super) grid: Grid,
    /// For each cell, true if a sphere with its centre there needs a distance query.
    near_wall: Vec<bool>,
    /// All spheres in order of placement.
    pub(crate) spheres: Vec<ReducedSphere>,
}

impl<'a> Assembly<'a> {
    /// An empty assembly in the box from the origin to `extent`.
    pub(crate) fn new(
        settings: SizeSettings<'a>,
        boundary: &'a Boundary,
        extent: &Vector3,
    ) -> Self {
        let largest = settings.radius_range[1];
        let reduced = settings.radius_range.map(|r| r / (1.0 + settings.overlap));
        let origin = Vector3::zeros();
        let grid = Grid::new(&origin, extent, reduced, settings.most_cells);
        let near_wall = cells_near_wall(&grid, boundary, largest * settings.wall_factor);
        Self {
            settings,
            boundary,
            grid,
            near_wall,
            spheres: Vec::new(),
        }
    }

    /// Adds a sphere that is known to fit.
    pub(crate) fn add(&mut self, sphere: ReducedSphere) {
        self.grid.insert(sphere);
        self.spheres.push(sphere);
    }

    /// A sphere of this (not reduced) radius.
    pub(crate) fn sphere(&self, centre: &Vector3, radius: f64) -> ReducedSphere {
        [centre.x, centre.y, centre.z, self.reduced(radius)]
    }

    /// Radius (not reduced) of a quantile of the sizes.
    pub(crate) fn radius(&self, quantile: f64) -> f64 {
        (self.settings.radius)(quantile)
    }

    /// The reduced radius of a (not reduced) radius: spheres of reduced radii do not overlap.
    pub(crate) fn reduced(&self, radius: f64) -> f64 {
        radius / (1.0 + self.settings.overlap)
    }

    /// Distance from a point to the nearest sphere's surface (reduced radius), at most `cut_off`,
    /// local units.
    pub(crate) fn gap(&self, point: &Vector3, cut_off: f64) -> f64 {
        // Wider and wider, since most points are close to a sphere.
        let mut searched = 2.0 * self.reduced(self.settings.radius_range[0]);
        loop {
            searched = searched.min(cut_off);
            let mut gap = searched;
            self.grid.near((*point).into(), searched, |cell| {
                for sphere in cell {
                    gap = gap.min(distance(sphere, point) - sphere[3]);
                }
            });
            if gap < searched || searched == cut_off {
                return gap;
            }
            searched *= 2.0;
        }
    }

    /// True if a sphere of this (not reduced) radius with its centre here, known to be inside the
    /// solid, overlaps neither sphere nor wall.
    pub(crate) fn fits(&self, centre: &Vector3, radius: f64) -> bool {
        let reduced = self.reduced(radius);
        self.gap(centre, 1.001 * reduced) >= reduced * (1.0 - 1e-12)
            && self.boundary.clears(centre, self.wall_clearance(radius))
    }

    /// Radius (not reduced) of the largest sphere around `point` that overlaps no other, at most
    /// `cut_off`, local units.
    pub(crate) fn reach_to_spheres(&self, point: &Vector3, cut_off: f64) -> f64 {
        self.gap(point, cut_off) * (1.0 + self.settings.overlap)
    }

    /// True if a sphere of this (not reduced) radius lies inside the surface, given that its centre
    /// does not lie beyond it.
    pub(super) fn clears_wall(&self, centre: &Vector3, radius: f64) -> bool {
        !self.is_near_wall(&[centre.x, centre.y, centre.z, 0.0])
            || self.boundary.clears(centre, self.wall_clearance(radius))
    }

    /// Least distance from the wall of the centre of a sphere of this (not reduced) radius.
    pub(super) fn wall_clearance(&self, radius: f64) -> f64 {
        radius * self.settings.wall_factor
    }

    /// True if the cell of the sphere's centre is near the wall.
    pub(super) fn is_near_wall(&self, sphere: &ReducedSphere) -> bool {
        self.near_wall[self.cell_of(sphere)]
    }

    /// The number of the cell that contains the sphere's centre.
    pub(super) fn cell_of(&self, sphere: &ReducedSphere) -> usize {
        let lattice = self.grid.lattice();
        lattice.index(lattice.cell_of(sphere[0], sphere[1], sphere[2]))
    }

    /// The smaller of the distance to the wall, divided by the factor by which a sphere keeps clear
    /// of it, and the distance to the spheres around, as a (not reduced) radius.
    pub(crate) fn clearance(&self, place: &Vector3, cut_off: f64) -> f64 {
        let to_spheres = self.reach_to_spheres(place, cut_off);
        let factor = self.settings.wall_factor;
        let wall = self.boundary.nearest(place, to_spheres * factor);
        wall.map_or(to_spheres, |near| near.distance / factor)
    }
}

/// For each cell of a grid, true if one of its points may be closer than `distance` to the wall.
pub(super) fn cells_near_wall(grid: &Grid, boundary: &Boundary, distance: f64) -> Vec<bool> {
    let lattice = grid.lattice();
    let half_diagonal = 0.5 * 3.0_f64.sqrt() * lattice.cell;
    let [nx, ny, nz] = lattice.counts;
    let is_near = |at: usize| {
        let cell = [at % nx, at / nx % ny, at / (nx * ny)];
        let is_outermost = cell
            .iter()
            .zip(lattice.counts)
            .any(|(c, n)| *c == 0 || *c + 1 == n);
        is_outermost || !boundary.clears(&lattice.centre(cell), half_diagonal + distance)
    };
    (0..nx * ny * nz).into_par_iter().map(is_near).collect()
}
