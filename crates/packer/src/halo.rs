//! The halo of a sphere: the places where a new sphere would touch it and two neighbours (Lozano 2016; Platzer 2022, section 4.1.2).
//!
//! The centre of a sphere of reduced radius g that touches sphere i lies on a sphere around x_i of radius g_i + g, the halo.
//! Every neighbour cuts a cap out of the halo, where the new sphere would overlap it, and so does a wall.
//! A place on the halo is a unit vector p; the cap around the unit vector u is p . u > c.
//! Candidate points are the corners of the free area: where the rims of two caps meet and no other cap covers the point.

use crate::Vector3;
use crate::grid::Ball;

/// Rims may be crossed by this much: overlaps stay below 1e-11 of a radius.
const RIM_TOLERANCE: f64 = 1e-12;
/// The caps are tested in groups of this many, without a branch inside.
const LANES: usize = 8;

/// The caps on the halo of one sphere for one radius of the new sphere. Reused from call to call.
#[derive(Debug, Default)]
pub struct Halo {
    /// Centre of the halo, local units.
    pub centre: Vector3,
    /// Radius of the halo, local units.
    pub radius: f64,
    /// Axes and rims of the caps, as arrays padded to a multiple of `LANES` with caps that cover nothing.
    ux: Vec<f64>,
    uy: Vec<f64>,
    uz: Vec<f64>,
    rim: Vec<f64>,
    /// Number of caps that come from spheres.
    spheres: usize,
    /// Axes and rims of the caps that come from walls.
    pub walls: Vec<(Vector3, f64)>,
}

/// Spheres near one front sphere, with the distances that all radii of a new sphere share.
#[derive(Debug, Default)]
pub struct Neighbours {
    axis: Vec<Vector3>,
    distance: Vec<f64>,
    radius: Vec<f64>,
}

impl Neighbours {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.axis.clear();
        self.distance.clear();
        self.radius.clear();
    }

    /// Adds those of `balls` that a new sphere of reduced radius `largest` on the halo of `ball` could touch.
    pub fn gather(&mut self, ball: &Ball, balls: &[Ball], largest: f64) {
        for other in balls {
            let d = Vector3::new(other[0] - ball[0], other[1] - ball[1], other[2] - ball[2]);
            let squared = d.norm_squared();
            let reach = ball[3] + other[3] + 2.0 * largest;
            if squared < reach * reach && squared > 0.0 {
                let distance = squared.sqrt();
                self.axis.push(d / distance);
                self.distance.push(distance);
                self.radius.push(other[3]);
            }
        }
    }
}

impl Halo {
    /// The halo of `ball` for a new sphere of reduced radius `new`, with the caps of its neighbours.
    pub fn set(&mut self, ball: &Ball, new: f64, neighbours: &Neighbours) {
        self.centre = Vector3::new(ball[0], ball[1], ball[2]);
        self.radius = ball[3] + new;
        for array in [&mut self.ux, &mut self.uy, &mut self.uz, &mut self.rim] {
            array.clear();
        }
        for k in 0..neighbours.axis.len() {
            let (distance, touching) = (neighbours.distance[k], neighbours.radius[k] + new);
            if distance < self.radius + touching {
                let rim = (self.radius * self.radius + distance * distance - touching * touching) / (2.0 * self.radius * distance);
                self.push(&neighbours.axis[k], rim);
            }
        }
        self.spheres = self.rim.len();
        self.walls.clear();
        while self.rim.len() % LANES != 0 {
            self.push(&Vector3::zeros(), f64::INFINITY);
        }
    }

    fn push(&mut self, axis: &Vector3, rim: f64) {
        self.ux.push(axis.x);
        self.uy.push(axis.y);
        self.uz.push(axis.z);
        self.rim.push(rim);
    }

    /// Adds a wall as a cap: its direction from the front sphere, and the distance to it less the radius of the new sphere.
    /// Caps of walls give candidate points; whether a place is inside the surface is for the distance query to say.
    pub fn add_wall(&mut self, towards: &Vector3, clearance: f64) {
        self.walls.push((*towards, clearance / self.radius));
    }

    /// Number of neighbours that cut the halo.
    pub fn neighbours(&self) -> usize {
        self.spheres
    }

    /// Axis and rim of one cap.
    pub fn cap(&self, k: usize) -> (Vector3, f64) {
        (Vector3::new(self.ux[k], self.uy[k], self.uz[k]), self.rim[k])
    }

    /// Whether no neighbour's cap covers the place.
    #[inline]
    pub fn is_free(&self, p: &Vector3) -> bool {
        let (px, py, pz) = (p.x, p.y, p.z);
        let groups = self.ux.chunks_exact(LANES).zip(self.uy.chunks_exact(LANES)).zip(self.uz.chunks_exact(LANES)).zip(self.rim.chunks_exact(LANES));
        for (((ux, uy), uz), rim) in groups {
            let mut covered = false;
            for k in 0..LANES {
                covered |= ux[k] * px + uy[k] * py + uz[k] * pz > rim[k] + RIM_TOLERANCE;
            }
            if covered {
                return false;
            }
        }
        true
    }

    /// Position in space of a place on the halo, local units.
    pub fn position(&self, p: &Vector3) -> Vector3 {
        self.centre + p * self.radius
    }
}

/// The two unit vectors where the rims of two caps meet, if they do.
#[inline]
pub fn rims_meet(u_a: &Vector3, rim_a: f64, u_b: &Vector3, rim_b: f64) -> Option<[Vector3; 2]> {
    let cosine = u_a.dot(u_b);
    let sine_squared = 1.0 - cosine * cosine;
    if sine_squared < 1e-12 {
        return None;
    }
    let along_a = (rim_a - cosine * rim_b) / sine_squared;
    let along_b = (rim_b - cosine * rim_a) / sine_squared;
    let height_squared = (1.0 - along_a * rim_a - along_b * rim_b) / sine_squared;
    if height_squared < 0.0 {
        return None;
    }
    let foot = u_a * along_a + u_b * along_b;
    let off = u_a.cross(u_b) * height_squared.sqrt();
    Some([foot + off, foot - off])
}
