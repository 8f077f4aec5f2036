//! Signed distance to the surface at any point, made cheap by a coarse grid: each cell stores
//! whether the surface is far, on which side the cell lies, and which triangles of the wall can be
//! nearest.
//!
//! For cells with many such triangles, the distances d_i of the cell's corners c_i bound that of a
//! point p. With q over the surface, d(p)^2 - |p|^2 is the minimum of |q|^2 - 2 p.q, so it is
//! concave: it is at least the value interpolated between the corners. Also, d(p) is at most the
//! distance to the point of the surface that is nearest to a corner.

use super::boundary::Boundary;
use super::inside::is_inside;
use crate::spheres::Vector3;
use dem_io::Surface;
use rayon::prelude::*;

/// Largest number of cells along the longest edge of the bounding box.
const MOST_CELLS_ALONG: f64 = 100.0;
/// Smallest number of cells in the solid: with few spheres, finer cells save more than they cost.
const FEWEST_CELLS: f64 = 10_000.0;
/// Largest number of candidates for the nearest triangle in a cell; with more, the tree is
/// searched.
const MOST_TRIANGLES: usize = 12;
/// Relative margin for rounding when distances are compared.
const MARGIN: f64 = 1e-9;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    /// The entire cell is inside, deeper than the cut-off.
    Deep,
    /// The entire cell is inside.
    Inside,
    /// The entire cell is outside.
    Outside,
    /// The surface may pass through it.
    Crossed,
}

impl Cell {
    fn is_bounded_by_corners(&self) -> bool {
        self.side == Side::Inside && !self.complete
    }
}

#[derive(Clone, Copy)]
struct Cell {
    side: Side,
    /// Lower limit of the distance between the cell and the surface, local units.
    clear: f64,
    /// Its triangles in the list of its row: those that can be nearest, or only the nearest to its
    /// centre.
    first: u32,
    count: u32,
    /// True if no other triangle can be nearest.
    complete: bool,
}

/// A corner of cells.
#[derive(Clone, Copy)]
struct Corner {
    /// Square of its distance to the surface, or of the cut-off if that is smaller.
    squared: f64,
    /// The nearest point of the surface, if nearer than the cut-off.
    nearest: Option<Vector3>,
}

/// Cells along x and the triangles that they point to.
struct Row {
    cells: Vec<Cell>,
    triangles: Vec<u32>,
}

/// For the cells of a grid, which side of the surface they are on and what is near.
pub struct DepthMap<'a> {
    boundary: &'a Boundary,
    cut_off: f64,
    edge: f64,
    counts: [usize; 3],
    rows: Vec<Row>,
    /// Corners of the cells that are inside and near many triangles, x fastest. Empty if there are
    /// none.
    corners: Vec<Option<Corner>>,
    /// True if no other part touches the wall from outside: then all that is in front of the wall
    /// is outside.
    one_part: bool,
}

impl<'a> DepthMap<'a> {
    /// Prepares distances up to `cut_off` with cells of at most `edge`, unless that is less than a
    /// hundredth of the longest side of the bounding box (local units).
    pub fn new(surface: &'a Surface, boundary: &'a Boundary, cut_off: f64, edge: f64) -> Self {
        let extent = surface.extent();
        let volume = surface.volume_m3() / surface.unit_m.powi(3);
        let finer = (volume / FEWEST_CELLS).cbrt();
        let edge = edge
            .min(finer)
            .max(extent.iter().copied().fold(0.0, f64::max) / MOST_CELLS_ALONG);
        let counts = extent.map(|e| (e / edge) as usize + 1);
        let mut map = Self {
            boundary,
            cut_off,
            edge,
            counts,
            rows: Vec::new(),
            corners: Vec::new(),
            one_part: surface.repairs.self_intersections == 0 && surface.parts() == 1,
        };
        map.rows = (0..counts[1] * counts[2])
            .into_par_iter()
            .map(|row| map.row(row % counts[1], row / counts[1]))
            .collect();
        map.corners = map.measured_corners();
        map
    }

    fn measured_corners(&self) -> Vec<Option<Corner>> {
        let [nx, ny, nz] = self.counts.map(|c| c + 1);
        let mut needed = vec![false; nx * ny * nz];
        let mut any = false;
        for (at, row) in self.rows.iter().enumerate() {
            let (y, z) = (at % self.counts[1], at / self.counts[1]);
            for (x, cell) in row.cells.iter().enumerate() {
                if cell.is_bounded_by_corners() {
                    any = true;
                    for corner in self.corners_of([x, y, z]) {
                        needed[corner] = true;
                    }
                }
            }
        }
        if !any {
            return Vec::new();
        }
        let measured = |(at, needed): (usize, bool)| {
            if !needed {
                return None;
            }
            let corner = [at % nx, at / nx % ny, at / (nx * ny)];
            let place = Vector3::from(corner.map(|c| c as f64 * self.edge));
            let near = self.boundary.nearest(&place, self.cut_off);
            Some(Corner {
                squared: near.map_or(self.cut_off, |n| n.distance).powi(2),
                nearest: near.map(|n| n.point),
            })
        };
        needed.into_par_iter().enumerate().map(measured).collect()
    }

    /// Positions of the eight corners of a cell among all, x fastest.
    fn corners_of(&self, [x, y, z]: [usize; 3]) -> [usize; 8] {
        let [nx, ny, _] = self.counts.map(|c| c + 1);
        [0, 1, 2, 3, 4, 5, 6, 7]
            .map(|i| (x + (i & 1)) + nx * ((y + (i >> 1 & 1)) + ny * (z + (i >> 2))))
    }

    fn row(&self, y: usize, z: usize) -> Row {
        let half_diagonal = 0.5 * 3.0_f64.sqrt() * self.edge;
        let mut row = Row {
            cells: Vec::with_capacity(self.counts[0]),
            triangles: Vec::new(),
        };
        // The side is the same from a cell without surface to the next.
        let mut known_side = None;
        // Lower limit of the distance between the last centre and the surface, if it is outside.
        let mut far_outside = 0.0;
        // The triangle nearest to the last centre that had one within reach.
        let mut nearest_before = None;
        for x in 0..self.counts[0] {
            far_outside -= self.edge;
            if far_outside > 2.0 * half_diagonal {
                row.cells.push(Cell {
                    side: Side::Outside,
                    clear: far_outside - half_diagonal,
                    first: row.triangles.len() as u32,
                    count: 0,
                    complete: false,
                });
                continue;
            }
            let centre = Vector3::from([x, y, z].map(|c| (c as f64 + 0.5) * self.edge));
            let cut_off = self.cut_off + half_diagonal;
            let nearest = self.nearest_with_hint(&centre, cut_off, nearest_before);
            nearest_before = nearest.map(|(_, triangle)| triangle).or(nearest_before);
            let distance = nearest.map_or(f64::INFINITY, |(distance, _)| distance);
            let crossed = distance <= half_diagonal * (1.0 + MARGIN);
            known_side = if crossed {
                None
            } else {
                known_side.or_else(|| Some(is_inside(self.boundary, &centre)))
            };
            let first = row.triangles.len();
            let side = match (known_side, nearest) {
                (Some(false), _) => Side::Outside,
                (Some(true), None) => Side::Deep,
                (Some(true), _) => Side::Inside,
                (None, _) => Side::Crossed,
            };
            if side == Side::Outside {
                far_outside = distance.min(cut_off);
            }
            let mut complete = false;
            if let Some((_, triangle)) = nearest
                && side != Side::Outside
            {
                // For a point of the cell, the nearest triangle is at most half a diagonal farther
                // away than for the centre.
                let reach = (distance + 2.0 * half_diagonal) * (1.0 + MARGIN);
                complete = self.list(&centre, reach, &mut row.triangles);
                if !complete {
                    row.triangles.truncate(first);
                    row.triangles.push(triangle);
                }
            }
            row.cells.push(Cell {
                side,
                clear: (distance.min(cut_off) - half_diagonal).max(0.0),
                first: first as u32,
                count: (row.triangles.len() - first) as u32,
                complete,
            });
        }
        row
    }

    /// The distance of the nearest triangle, if it is below `cut_off`, and that triangle, searched
    /// for no farther away than the one that was nearest to a point beside.
    fn nearest_with_hint(
        &self,
        point: &Vector3,
        cut_off: f64,
        hint: Option<u32>,
    ) -> Option<(f64, u32)> {
        let of_hint = hint
            .map(|triangle| (self.boundary.nearest_on(triangle, point).distance, triangle))
            .filter(|(distance, _)| *distance < cut_off);
        let bound = of_hint.map_or(cut_off, |(distance, _)| distance);
        self.nearest_in_tree(point, bound).or(of_hint)
    }

    /// The distance of the nearest triangle, if it is below `cut_off`, and that triangle.
    fn nearest_in_tree(&self, point: &Vector3, cut_off: f64) -> Option<(f64, u32)> {
        let nearest = self.boundary.nearest(point, cut_off);
        nearest.map(|near| (near.distance, near.triangle))
    }

    /// Adds the triangles that may be within `reach` of a point; false if there are too many.
    fn list(&self, centre: &Vector3, reach: f64, triangles: &mut Vec<u32>) -> bool {
        let most = triangles.len() + MOST_TRIANGLES;
        for triangle in self.boundary.triangles_near(centre, reach) {
            if self.boundary.may_be_nearer(triangle, centre, reach) {
                if triangles.len() == most {
                    return false;
                }
                triangles.push(triangle);
            }
        }
        true
    }

    /// Bounds of the distance to the surface (see [`DepthMap::depth`]) at little cost; they may be
    /// infinite.
    pub fn bounds(&self, point: [f64; 3]) -> [f64; 2] {
        const NONE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
        let place = [0, 1, 2].map(|k| (point[k] / self.edge).floor());
        if (0..3).any(|k| place[k] < 0.0 || place[k] >= self.counts[k] as f64) {
            return NONE;
        }
        let [x, y, z] = place.map(|c| c as usize);
        let cell = self.rows[z * self.counts[1] + y].cells[x];
        match cell.side {
            Side::Deep => return [self.cut_off, f64::INFINITY],
            Side::Outside => return [f64::NEG_INFINITY, -cell.clear],
            _ if !cell.is_bounded_by_corners() => return NONE,
            _ => {}
        }
        let within = [0, 1, 2].map(|k| point[k] - place[k] * self.edge);
        let fraction = within.map(|w| w / self.edge);
        let point = Vector3::from(point);
        let mut squared = within.iter().map(|w| w * w).sum::<f64>();
        let mut most = f64::INFINITY;
        for (i, corner) in self.corners_of([x, y, z]).into_iter().enumerate() {
            let Some(corner) = self.corners[corner] else {
                return NONE;
            };
            let far = [i & 1 == 1, i >> 1 & 1 == 1, i >> 2 == 1];
            let weight: f64 = (0..3)
                .map(|k| {
                    if far[k] {
                        fraction[k]
                    } else {
                        1.0 - fraction[k]
                    }
                })
                .product();
            let from_first = far.iter().filter(|f| **f).count() as f64 * self.edge * self.edge;
            squared += weight * (corner.squared - from_first);
            if let Some(nearest) = corner.nearest {
                most = most.min((point - nearest).norm_squared());
            }
        }
        [
            squared.max(0.0).sqrt() * (1.0 - MARGIN),
            most.sqrt() * (1.0 + MARGIN),
        ]
    }

    /// Distance to the surface, positive inside, infinite beyond the cut-off. Outside it is
    /// negative or zero, and its magnitude never exceeds the true distance but may be smaller.
    pub fn depth(&self, point: [f64; 3]) -> f64 {
        let cell = [0, 1, 2].map(|k| (point[k] / self.edge).floor());
        if (0..3).any(|k| cell[k] < 0.0 || cell[k] >= self.counts[k] as f64) {
            return 0.0;
        }
        let [x, y, z] = cell.map(|c| c as usize);
        let row = &self.rows[z * self.counts[1] + y];
        let cell = row.cells[x];
        match cell.side {
            Side::Deep => return f64::INFINITY,
            Side::Outside => return -cell.clear,
            Side::Inside | Side::Crossed => {}
        }
        let point = Vector3::from(point);
        let listed = &row.triangles[cell.first as usize..(cell.first + cell.count) as usize];
        let Some((distance, triangle)) = self.nearest(&point, listed, cell.complete) else {
            return f64::INFINITY;
        };
        let inside = cell.side == Side::Inside
            || match self.boundary.is_behind(triangle, &point) {
                Some(true) => true,
                Some(false) if self.one_part => false,
                _ => is_inside(self.boundary, &point),
            };
        match (inside, distance > self.cut_off) {
            (true, true) => f64::INFINITY,
            (true, false) => distance,
            (false, _) => -distance,
        }
    }

    /// The nearest triangle and its distance, if it is listed or nearer than the cut-off.
    fn nearest(&self, point: &Vector3, listed: &[u32], complete: bool) -> Option<(f64, u32)> {
        let of_list = listed
            .iter()
            .map(|t| (self.boundary.nearest_on(*t, point).distance, *t))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        if complete {
            return of_list;
        }
        let bound = of_list.map_or(self.cut_off, |(distance, _)| distance.min(self.cut_off));
        self.nearest_in_tree(point, bound).or(of_list)
    }
}
