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
/// Caps whose axes are nearer to parallel than this (sine squared) have no sharp corner.
const SMALLEST_SINE_SQUARED: f64 = 1e-8;
/// The caps are handled in groups of this many, without a branch inside.
const LANES: usize = 4;
/// A place that a cap covers by more than this in single precision is covered. The error of a place is below 3e-3, unless
const SURELY_COVERED: f32 = 4e-3;
/// the sine squared between the axes of the two caps is below this.
const SURELY_SHARP: f32 = 0.05;
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
    /// The caps that no other one contains, largest first.
    caps: Vec<Cap>,
    /// In single precision: the caps in groups of x, y, z, rims and sines squared, and one by one as x, y, z and rim.
    quick_groups: Vec<[[f32; LANES]; 5]>,
    quick: Vec<[f32; 4]>,
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
        // Largest first: they cover most, and may contain others.
        self.caps.sort_unstable_by(|a, b| a.rim.total_cmp(&b.rim));
        self.drop_contained();
        self.quick.clear();
        self.quick_groups.clear();
        for part in self.caps.chunks(LANES) {
            let mut group = [[0.0; LANES]; 5];
            for (k, cap) in part.iter().enumerate() {
                let numbers = [
                    cap.axis.x,
                    cap.axis.y,
                    cap.axis.z,
                    cap.rim,
                    cap.sine_squared,
                ]
                .map(|x| x as f32);
                for (array, number) in group.iter_mut().zip(numbers) {
                    array[k] = number;
                }
                self.quick
                    .push([numbers[0], numbers[1], numbers[2], numbers[3]]);
            }
            self.quick_groups.push(group);
        }
    }

    /// Drops caps that lie within a larger one: their rims are covered, and what they cover is covered without them.
    fn drop_contained(&mut self) {
        let mut kept = 0;
        for k in 0..self.caps.len() {
            let cap = self.caps[k];
            let contained = self.caps[..kept].iter().any(|larger| {
                // Angle between the axes <= difference of the caps' angles.
                let excess = larger.axis.dot(&cap.axis) - larger.rim * cap.rim;
                excess > 0.0 && excess * excess >= larger.sine_squared * cap.sine_squared
            });
            if !contained {
                self.caps[kept] = cap;
                kept += 1;
            }
        }
        self.caps.truncate(kept);
    }

    /// Whether no neighbour's cap covers the place.
    #[inline]
    pub fn is_free(&self, p: &Vector3) -> bool {
        !self
            .caps
            .iter()
            .any(|cap| cap.axis.dot(p) > cap.rim + RIM_TOLERANCE)
    }

    /// Calls `found` with each point where two rims meet and no cap covers, as long as it is better than the best one so far:
    /// its order, p . `wanted`, is smaller. `found` returns whether it takes it.
    ///
    /// Nearly all points are covered. Those are found out in single precision, `LANES` pairs of caps at a time.
    #[expect(
        clippy::needless_range_loop,
        reason = "several arrays side by side, lane by lane"
    )]
    pub fn corners(&self, wanted: &Vector3, mut found: impl FnMut(&Self, &Vector3) -> bool) {
        let mut least = f64::INFINITY;
        for j in 1..self.caps.len() {
            for (group, caps) in self.quick_groups[..j.div_ceil(LANES)].iter().enumerate() {
                let open = self.open_corners(j, caps);
                for lane in 0..LANES.min(j - group * LANES) {
                    if open[0][lane] | open[1][lane] {
                        self.check_corners(
                            &self.caps[j],
                            &self.caps[group * LANES + lane],
                            wanted,
                            &mut least,
                            &mut found,
                        );
                    }
                }
            }
        }
    }

    /// For each cap of a group whether the two points where its rim meets that of cap `j` may be free.
    #[expect(
        clippy::needless_range_loop,
        reason = "several arrays side by side, lane by lane"
    )]
    #[inline]
    fn open_corners(
        &self,
        j: usize,
        [x, y, z, rim, sine_squared]: &[[f32; LANES]; 5],
    ) -> [[bool; LANES]; 2] {
        let [a_x, a_y, a_z, a_rim] = self.quick[j];
        let a_sine_squared = 1.0 - a_rim * a_rim;
        let (mut meet, mut sharp) = ([0.0_f32; LANES], [0.0_f32; LANES]);
        // The corners: foot + off and foot - off.
        let mut corner = [[[0.0_f32; LANES]; 3]; 2];
        for k in 0..LANES {
            let cosine = a_x * x[k] + a_y * y[k] + a_z * z[k];
            let excess = cosine - a_rim * rim[k];
            let inner = a_sine_squared * sine_squared[k] - excess * excess;
            meet[k] = inner;
            sharp[k] = 1.0 - cosine * cosine;
            let inverse = 1.0 / if sharp[k] > 1e-6 { sharp[k] } else { 1e-6 };
            let along_a = (a_rim - cosine * rim[k]) * inverse;
            let along_b = (rim[k] - cosine * a_rim) * inverse;
            let height = if inner > 0.0 { inner } else { 0.0 }.sqrt() * inverse;
            let foot = [
                a_x * along_a + x[k] * along_b,
                a_y * along_a + y[k] * along_b,
                a_z * along_a + z[k] * along_b,
            ];
            let off = [
                (a_y * z[k] - a_z * y[k]) * height,
                (a_z * x[k] - a_x * z[k]) * height,
                (a_x * y[k] - a_y * x[k]) * height,
            ];
            for axis in 0..3 {
                corner[0][axis][k] = foot[axis] + off[axis];
                corner[1][axis][k] = foot[axis] - off[axis];
            }
        }
        let mut cover = [[f32::NEG_INFINITY; LANES]; 2];
        let mut open = [[false; LANES]; 2];
        for k in 0..LANES {
            // Rims that do not meet have no corners.
            let none = if meet[k] < -1e-6 {
                f32::INFINITY
            } else {
                f32::NEG_INFINITY
            };
            cover[0][k] = none;
            cover[1][k] = none;
        }
        for some in self.quick.chunks(LANES) {
            for [x, y, z, rim] in some {
                for (cover, corner) in cover.iter_mut().zip(&corner) {
                    for k in 0..LANES {
                        let by = x * corner[0][k] + y * corner[1][k] + z * corner[2][k] - rim;
                        cover[k] = if by > cover[k] { by } else { cover[k] };
                    }
                }
            }
            let mut covered = true;
            for k in 0..LANES {
                covered &= (cover[0][k] > SURELY_COVERED) & (cover[1][k] > SURELY_COVERED);
            }
            if covered {
                break;
            }
        }
        for side in 0..2 {
            for k in 0..LANES {
                let blunt = (sharp[k] < SURELY_SHARP) & (meet[k] >= -1e-6);
                open[side][k] = (cover[side][k] <= SURELY_COVERED) | blunt;
            }
        }
        open
    }

    /// The corners of two caps in double precision.
    fn check_corners(
        &self,
        a: &Cap,
        b: &Cap,
        wanted: &Vector3,
        least: &mut f64,
        found: &mut impl FnMut(&Self, &Vector3) -> bool,
    ) {
        let cosine = a.axis.dot(&b.axis);
        let excess = cosine - a.rim * b.rim;
        let inner = a.sine_squared * b.sine_squared - excess * excess;
        if inner < 0.0 || 1.0 - cosine * cosine < SMALLEST_SINE_SQUARED {
            return;
        }
        for p in corners_of(a, b, cosine, inner) {
            let p = p.normalize();
            let order = p.dot(wanted);
            if order < *least && self.is_free(&p) && found(self, &p) {
                *least = order;
            }
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
        let cosine = a.axis.dot(towards);
        let excess = cosine - a.rim * rim;
        let inner = a.sine_squared * wall.sine_squared - excess * excess;
        let sharp = inner >= 0.0 && 1.0 - cosine * cosine > SMALLEST_SINE_SQUARED;
        sharp.then(|| corners_of(&a, &wall, cosine, inner).map(|p| p.normalize()))
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

/// The two unit vectors where the rims of two caps meet: a foot in the plane of the axes, and as far off it to either side as `inner` says,
/// sin^2 sin^2 - (cosine - cos cos)^2 >= 0.
#[inline]
fn corners_of(a: &Cap, b: &Cap, cosine: f64, inner: f64) -> [Vector3; 2] {
    let inverse = 1.0 / (1.0 - cosine * cosine).max(SMALLEST_SINE_SQUARED);
    let foot = (a.axis * (a.rim - cosine * b.rim) + b.axis * (b.rim - cosine * a.rim)) * inverse;
    let off = a.axis.cross(&b.axis) * (inner.sqrt() * inverse);
    [foot + off, foot - off]
}
