//! The halo of a sphere: the places where a new sphere would touch it and two neighbours (Lozano 2016; Platzer 2022, section 4.1.2).
//!
//! The centre of a sphere of reduced radius g that touches sphere i lies on a sphere around x_i of radius g_i + g, the halo.
//! Every neighbour cuts a cap out of the halo, where the new sphere would overlap it, and so does a wall.
//! A place on the halo is a unit vector p; the cap around the unit vector u is p . u > c.
//! Candidate points are the corners of the free area: where the rims of two caps meet and no other cap covers the point.

use crate::Vector3;
use crate::grid::Ball;
use crate::rims::{LANES, Rims};

/// Rims may be crossed by this much: overlaps stay below 1e-11 of a radius.
const RIM_TOLERANCE: f64 = 1e-12;
/// Caps whose axes are nearer to parallel than this (sine squared) have no sharp corner.
const SMALLEST_SINE_SQUARED: f64 = 1e-8;
/// What a neighbour or a wall cuts out of a halo: the places p with p . axis > rim.
#[derive(Debug, Clone, Copy)]
struct Cap {
    axis: Vector3,
    /// Cosine of the cap's angle.
    rim: f64,
    /// Its sine, squared.
    sine_squared: f64,
}

/// The caps on the halo of one sphere for one radius of the new sphere. Reused from call to call.
#[derive(Debug, Default)]
pub struct Halo {
    /// Centre of the halo, local units.
    pub centre: Vector3,
    /// Radius of the halo, local units.
    pub radius: f64,
    /// Largest first.
    caps: Vec<Cap>,
    /// The same in single precision.
    rims: Rims,
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
        self.caps.clear();
        for k in 0..neighbours.axis.len() {
            let (distance, touching) = (neighbours.distance[k], neighbours.radius[k] + new);
            if distance < self.radius + touching {
                let rim = (self.radius * self.radius + distance * distance - touching * touching)
                    / (2.0 * self.radius * distance);
                self.caps.push(Cap {
                    axis: neighbours.axis[k],
                    rim,
                    sine_squared: 1.0 - rim * rim,
                });
            }
        }
        // Largest first: they cover most.
        self.caps.sort_unstable_by(|a, b| a.rim.total_cmp(&b.rim));
        self.rims.clear();
        for group in self.caps.chunks(LANES) {
            self.rims.push(group.iter().map(|cap| (cap.axis, cap.rim)));
        }
    }

    /// Whether no neighbour's cap covers the place.
    pub fn is_free(&self, p: &Vector3) -> bool {
        is_free(&self.caps, p)
    }

    /// Calls `found` with the position of each point where two rims meet and no cap covers, as long as it is better than the best one so far:
    /// its order, p . `wanted`, is smaller. `found` returns whether it takes it.
    ///
    /// Nearly all points are covered. Those are found out in single precision, see [`Rims`].
    pub fn corners(&mut self, wanted: &Vector3, mut found: impl FnMut(&Vector3) -> bool) {
        let mut least = f64::INFINITY;
        for j in 1..self.caps.len() {
            let caps = &self.caps;
            self.rims.open_corners(j, |k| {
                let Some(places) = corners_of(&caps[j], &caps[k]) else {
                    return;
                };
                for p in places {
                    let order = p.dot(wanted);
                    if order < least
                        && is_free(caps, &p)
                        && found(&(self.centre + p * self.radius))
                    {
                        least = order;
                    }
                }
            });
        }
    }

    /// The points where a wall touches the new sphere and a neighbour, covered or not. `towards` is the direction to the wall,
    /// `clearance` the distance of the wall from the front sphere's centre less the radius of the new sphere.
    pub fn wall_corners(
        &self,
        neighbour: usize,
        towards: &Vector3,
        clearance: f64,
    ) -> Option<[Vector3; 2]> {
        let rim = clearance / self.radius;
        let (a, wall) = (
            self.caps[neighbour],
            Cap {
                axis: *towards,
                rim,
                sine_squared: 1.0 - rim * rim,
            },
        );
        corners_of(&a, &wall)
    }

    /// Number of neighbours whose rims count.
    pub fn neighbours(&self) -> usize {
        self.caps.len()
    }

    /// Position in space of a place on the halo, local units.
    pub fn position(&self, p: &Vector3) -> Vector3 {
        self.centre + p * self.radius
    }
}

fn is_free(caps: &[Cap], p: &Vector3) -> bool {
    !caps
        .iter()
        .any(|cap| cap.axis.dot(p) > cap.rim + RIM_TOLERANCE)
}

/// The two unit vectors where the rims of two caps meet at an angle, if they do: a foot in the plane of the axes, and as far off it to
/// either side as sin^2 sin^2 - (cosine - cos cos)^2 >= 0 says.
fn corners_of(a: &Cap, b: &Cap) -> Option<[Vector3; 2]> {
    let cosine = a.axis.dot(&b.axis);
    let excess = cosine - a.rim * b.rim;
    let inner = a.sine_squared * b.sine_squared - excess * excess;
    let sine_squared = 1.0 - cosine * cosine;
    if inner < 0.0 || sine_squared < SMALLEST_SINE_SQUARED {
        return None;
    }
    let foot = a.axis * (a.rim - cosine * b.rim) + b.axis * (b.rim - cosine * a.rim);
    let off = a.axis.cross(&b.axis) * inner.sqrt();
    Some([foot + off, foot - off].map(|p| p.normalize()))
}
