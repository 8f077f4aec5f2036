//! How easily contacts move a rigid body of spheres: at one of them, and at all that a plane can
//! touch at once.

use std::collections::BinaryHeap;

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// Spheres touch a plane together if none is farther from it than this, in radii of the smallest.
const TOGETHER: f64 = 0.05;
/// Most directions that are looked at.
const MOST: usize = 400;

/// Inverse masses with which a body meets something, 1/kg.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Landing {
    /// At one sphere, where and in the direction in which it is moved most easily.
    pub alone_per_kg: f64,
    /// Most spheres that a plane can touch at once, or some more.
    pub together: u32,
    /// When as many are touched: the largest eigenvalue of their stiffness over mass, for a
    /// stiffness of 1 N/m of each.
    pub together_per_kg: f64,
}

/// A rigid body: mass, kg, principal moments of inertia, kg m2, and spheres, whose centres are
/// relative to the centre of mass and along the principal axes, with their radii, m.
#[derive(Debug)]
pub struct RigidSpheres {
    /// kg.
    pub mass_kg: f64,
    /// kg m2.
    pub moments_kg_m2: Vector3<f64>,
    /// Centres and radii, m.
    pub spheres: Vec<(Vector3<f64>, f64)>,
}

/// Directions about one, those within a square on a cube of edge 2.
#[derive(Debug, PartialEq)]
struct Cell {
    /// The most spheres that a plane across one of them can touch.
    together: usize,
    /// Number of halvings.
    depth: u32,
    /// Axis and sign of the cube's side, and coordinates of the middle of the square.
    side: (usize, f64),
    at: [f64; 2],
}

impl Eq for Cell {}

impl Ord for Cell {
    /// More spheres first, then smaller squares.
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.together, self.depth).cmp(&(other.together, other.depth))
    }
}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Cell {
    fn direction(&self) -> Vector3<f64> {
        let (axis, sign) = self.side;
        let mut direction = Vector3::zeros();
        direction[axis] = sign;
        direction[(axis + 1) % 3] = self.at[0];
        direction[(axis + 2) % 3] = self.at[1];
        direction.normalize()
    }

    /// Half the edge of the square.
    fn half(&self) -> f64 {
        0.5_f64.powi(self.depth as i32)
    }

    /// Largest distance of its unit vectors from that in the middle.
    fn radius(&self) -> f64 {
        std::f64::consts::SQRT_2 * self.half()
    }
}

impl RigidSpheres {
    /// How easily contacts move it.
    pub fn landing(&self) -> Landing {
        let alone = self.spheres.iter().map(|(arm, _)| self.alone_per_kg(arm));
        let cell = self.flattest();
        let direction = cell.direction();
        let touched = self.touched(&direction, cell.radius());
        let moved = touched
            .iter()
            .map(|&n| self.moved(&self.spheres[n].0, &direction));
        let sum = moved.fold(Matrix4::zeros(), |sum, one| sum + one * one.transpose());
        Landing {
            alone_per_kg: alone.fold(0.0, f64::max),
            together: touched.len() as u32,
            together_per_kg: sum.symmetric_eigenvalues().max(),
        }
    }

    /// One over the mass with which the sphere there resists a push, in the direction in which it
    /// resists least.
    fn alone_per_kg(&self, arm: &Vector3<f64>) -> f64 {
        let turning = arm.cross_matrix();
        let per_moments = Matrix3::from_diagonal(&self.moments_kg_m2.map(|moment| 1.0 / moment));
        let of_turning = turning.transpose() * per_moments * turning;
        1.0 / self.mass_kg + of_turning.symmetric_eigenvalues().max().max(0.0)
    }

    /// What a unit push on the sphere there moves, over the roots of mass and moments: along the
    /// direction, and about the axes.
    fn moved(&self, arm: &Vector3<f64>, direction: &Vector3<f64>) -> Vector4<f64> {
        let roots = self.moments_kg_m2.map(|moment| 1.0 / moment.sqrt());
        let turned = arm.cross(direction).component_mul(&roots);
        Vector4::new(1.0 / self.mass_kg.sqrt(), turned.x, turned.y, turned.z)
    }

    fn together_m(&self) -> f64 {
        let radii = self.spheres.iter().map(|(_, radius)| *radius);
        TOGETHER * radii.fold(f64::INFINITY, f64::min)
    }

    /// The spheres that a plane can touch at once, if it lies ahead across a unit vector no farther
    /// than `radius` from this direction.
    fn touched(&self, direction: &Vector3<f64>, radius: f64) -> Vec<usize> {
        let ahead = |(centre, r): &(Vector3<f64>, f64)| centre.dot(direction) + r;
        let farther =
            |a: &&(Vector3<f64>, f64), b: &&(Vector3<f64>, f64)| ahead(a).total_cmp(&ahead(b));
        let Some(first) = self.spheres.iter().max_by(farther) else {
            return Vec::new();
        };
        let (most_m, together_m) = (ahead(first), self.together_m());
        let is_touched = |n: &usize| {
            let sphere = &self.spheres[*n];
            let tilted_m = radius * (first.0 - sphere.0).norm();
            most_m - ahead(sphere) <= together_m + tilted_m
        };
        (0..self.spheres.len()).filter(is_touched).collect()
    }

    /// The directions in which most spheres touch a plane at once: by halving the squares with the
    /// largest bounds. If that takes too long, there may be fewer than it says.
    fn flattest(&self) -> Cell {
        let norms = self.spheres.iter().map(|(centre, _)| centre.norm());
        let span_m = 2.0 * norms.fold(0.0, f64::max);
        let cell = |side, at, depth| {
            let cell = Cell {
                together: 0,
                depth,
                side,
                at,
            };
            let touched = self.touched(&cell.direction(), cell.radius());
            Cell {
                together: touched.len(),
                ..cell
            }
        };
        let sides = (0..3).flat_map(|axis| [(axis, 1.0), (axis, -1.0)]);
        let mut cells: BinaryHeap<Cell> = sides.map(|side| cell(side, [0.0; 2], 0)).collect();
        let mut looked_at = cells.len();
        loop {
            let Some(best) = cells.pop() else {
                return cell((0, 1.0), [0.0; 2], 0);
            };
            if looked_at >= MOST || best.radius() * span_m <= 0.5 * self.together_m() {
                return best;
            }
            let quarter = 0.5 * best.half();
            for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let at = [best.at[0] + x * quarter, best.at[1] + y * quarter];
                cells.push(cell(best.side, at, best.depth + 1));
            }
            looked_at += 4;
        }
    }
}
