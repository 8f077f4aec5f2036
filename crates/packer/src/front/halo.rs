//! The halo of a sphere: the places where a new sphere would touch it and two neighbours (Lozano
//! 2016; Platzer 2022, section 4.1.2).
//!
//! The centre of a sphere of reduced radius g that touches sphere i lies on a sphere around x_i of
//! radius g_i + g, the halo. Every neighbour cuts a cap out of the halo, where the new sphere would
//! overlap it, and so does a wall. A place on the halo is a unit vector p; the cap around the unit
//! vector u is p . u > c. Candidate points are the corners of the free area: where the rims of two
//! caps meet and no other cap covers the point.

use super::rims::{LANES, Rims};
use crate::grid::curve_position;
use crate::spheres::{ReducedSphere, Vector3};
use pulp::Arch;

/// Tolerance for crossing a rim: overlaps stay below 1e-11 of a radius.
const RIM_TOLERANCE: f64 = 1e-12;
/// Caps whose axes are nearer to parallel than this (sine squared) have no sharp corner.
const SMALLEST_SINE_SQUARED: f64 = 1e-8;
/// Edge of the cells on the unit sphere by which directions are ordered.
const DIRECTIONS: f64 = 1.0 / 64.0;
/// Relative to `wanted`: orders are sorted in single precision, and corners of rims that meet at a
/// small angle are left out.
const ROUNDING: f64 = 1e-6;
/// Number of caps above which those near each other are looked at together, and sizes learn from
/// smaller ones.
const MANY: usize = 64;
/// Numbers of the nearest neighbours that may cover a halo.
const NEAREST: [usize; 2] = [8, 32];

/// The part that a neighbour or a wall cuts out of a halo: the places p with p . axis > rim.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cap {
    pub(super) axis: Vector3,
    /// Cosine of the cap's angle.
    pub(super) rim: f64,
    pub(super) sine_squared: f64,
}

/// The caps on the halo of one sphere for one radius of the new sphere. Reused from call to call.
#[derive(Debug, Default)]
pub struct Halo {
    /// Centre of the halo, local units.
    pub centre: Vector3,
    /// Radius of the halo, local units.
    pub radius: f64,
    /// Largest first, nearly: they cover most.
    pub(super) caps: Vec<Cap>,
    /// The same caps in single precision.
    rims: Rims,
    /// The smallest order of any point on a rim in the upper half, the number of its cap in the
    /// lower half.
    order: Vec<u64>,
}

/// A sphere near one front sphere, with the quantities common to all radii of a new sphere.
#[derive(Debug, Clone, Copy)]
struct Neighbour {
    axis: Vector3,
    distance: f64,
    radius: f64,
}

/// Spheres near one front sphere.
#[derive(Debug, Default)]
pub struct Neighbours {
    all: Vec<Neighbour>,
    /// Their order by the distance between surfaces, or by direction where many small ones surround
    /// a large one: that in the upper half, the index in the lower half.
    order: Vec<u64>,
}

impl Neighbours {
    /// Removes all spheres.
    pub fn clear(&mut self) {
        self.all.clear();
        self.order.clear();
    }

    /// Adds those of `balls` that a new sphere of reduced radius `largest` on the halo of `ball`
    /// could touch.
    pub fn gather(&mut self, ball: &ReducedSphere, balls: &[ReducedSphere], largest: f64) {
        for other in balls {
            let d = Vector3::new(other[0] - ball[0], other[1] - ball[1], other[2] - ball[2]);
            let squared = d.norm_squared();
            let reach = ball[3] + other[3] + 2.0 * largest;
            if squared < reach * reach && squared > 0.0 {
                let distance = squared.sqrt();
                let axis = d / distance;
                let order = if 2.0 * largest < ball[3] {
                    curve_position((axis.add_scalar(1.0)).into(), DIRECTIONS)
                } else {
                    // The bits of positive numbers have the same order as the numbers.
                    u64::from(((distance - other[3]).max(0.0) as f32).to_bits())
                };
                self.order.push(order << 32 | self.all.len() as u64);
                self.all.push(Neighbour {
                    axis,
                    distance,
                    radius: other[3],
                });
            }
        }
    }

    /// Adds one sphere to sorted neighbours, as `gather` and `sort` would.
    pub(crate) fn insert(&mut self, ball: &ReducedSphere, other: &ReducedSphere, largest: f64) {
        let before = self.order.len();
        self.gather(ball, std::slice::from_ref(other), largest);
        if let Some(entry) = self.order.get(before).copied() {
            self.order.truncate(before);
            let place = self.order.partition_point(|earlier| *earlier < entry);
            self.order.insert(place, entry);
        }
    }

    /// Sorts the nearest neighbours first, as their caps are the largest, or by direction.
    pub fn sort(&mut self) {
        self.order.sort_unstable();
    }
}

impl Halo {
    /// The halo of `ball` for a new sphere of reduced radius `new`, with the caps of its
    /// neighbours.
    pub fn set(&mut self, ball: &ReducedSphere, new: f64, neighbours: &Neighbours) {
        self.set_nearest(ball, new, neighbours, usize::MAX);
    }

    /// As [`Halo::set`], unless the nearest neighbours alone cover the halo, as where a large
    /// sphere is tried beside a small one: then false.
    pub(crate) fn set_unless_covered(
        &mut self,
        ball: &ReducedSphere,
        new: f64,
        neighbours: &Neighbours,
    ) -> bool {
        for nearest in NEAREST {
            if neighbours.order.len() > 2 * nearest {
                self.set_nearest(ball, new, neighbours, nearest);
                if self.is_covered() {
                    return false;
                }
            }
        }
        self.set(ball, new, neighbours);
        true
    }

    /// True if the caps certainly cover the halo: no point of any rim is free.
    pub(crate) fn is_covered(&mut self) -> bool {
        let Self { caps, rims, .. } = self;
        Arch::new().dispatch(
            #[inline(always)]
            || !caps.is_empty() && (0..caps.len()).all(|j| rims.is_covered(j)),
        )
    }

    fn set_nearest(
        &mut self,
        ball: &ReducedSphere,
        new: f64,
        neighbours: &Neighbours,
        nearest: usize,
    ) {
        self.centre = Vector3::new(ball[0], ball[1], ball[2]);
        self.radius = ball[3] + new;
        self.caps.clear();
        for entry in neighbours.order.iter().take(nearest) {
            let Neighbour {
                axis,
                distance,
                radius,
            } = neighbours.all[(entry & 0xffff_ffff) as usize];
            let touching = radius + new;
            if distance < self.radius + touching {
                let rim = (self.radius * self.radius + distance * distance - touching * touching)
                    / (2.0 * self.radius * distance);
                self.caps.push(Cap {
                    axis,
                    rim,
                    sine_squared: 1.0 - rim * rim,
                });
            }
        }
        self.group_rims();
    }

    /// Adds the caps of flat walls: the direction to each, and its distance from the halo's centre
    /// less the radius of the new sphere.
    pub(crate) fn add_walls(&mut self, walls: impl Iterator<Item = (Vector3, f64)>) {
        let radius = self.radius;
        let caps = walls.map(|(axis, clearance)| {
            let rim = clearance / radius;
            Cap {
                axis,
                rim,
                sine_squared: 1.0 - rim * rim,
            }
        });
        self.caps.splice(0..0, caps.filter(|cap| cap.rim < 1.0));
        self.group_rims();
    }

    fn group_rims(&mut self) {
        self.rims.clear();
        for group in self.caps.chunks(LANES) {
            self.rims.push(group.iter().map(|cap| (cap.axis, cap.rim)));
        }
        if self.caps.len() > MANY {
            self.rims.enclose_groups();
        }
    }

    /// True if no neighbour's cap covers the place.
    pub(crate) fn is_free(&self, p: &Vector3) -> bool {
        is_free(&self.caps, p)
    }

    /// Calls `found` with the position of each point where two rims meet and no cap covers, as long
    /// as it is better than the best one so far, which means that its order, p . `wanted`, is
    /// smaller. `found` returns true if it accepts the point. The caller knows that no free place
    /// has an order below `from`.
    ///
    /// Returns an order below which no place is free, in the units of `wanted`; minus infinity if
    /// it is not known. With the same front sphere and the same `wanted` it holds for larger
    /// spheres that are tried later as well: a smaller one that touches the front sphere at the
    /// same point lies inside the larger one.
    ///
    /// Nearly all points are covered. They are eliminated in single precision, see rims.rs.
    pub fn corners(
        &mut self,
        wanted: &Vector3,
        from: f64,
        found: impl FnMut(&Vector3) -> bool,
    ) -> f64 {
        let least = Arch::new().dispatch(
            #[inline(always)]
            || self.visit_corners(wanted, from, found),
        );
        least.min(self.least_beside_corners(wanted))
    }

    /// The smallest order of a free corner; infinite if there is none.
    #[inline(always)]
    fn visit_corners(
        &mut self,
        wanted: &Vector3,
        from: f64,
        mut found: impl FnMut(&Vector3) -> bool,
    ) -> f64 {
        let squared = wanted.norm_squared();
        let length = squared.sqrt();
        self.order.clear();
        for (j, cap) in self.caps.iter().enumerate() {
            let along = cap.axis.dot(wanted);
            let across = (cap.sine_squared * (squared - along * along))
                .max(0.0)
                .sqrt();
            if cap.rim * along + across < from - ROUNDING * length {
                continue;
            }
            // From 0 to 4; the bits of positive numbers have the same order as the numbers.
            let least = 2.0 + (cap.rim * along - across) / length;
            let order = u64::from((least as f32).max(0.0).to_bits());
            self.order.push(order << 32 | j as u64);
        }
        self.order.sort_unstable();
        let (mut least, mut of_rim) = (f64::INFINITY, 0);
        let mut least_free = f64::INFINITY;
        for entry in &self.order {
            let least_on_rim = f64::from(f32::from_bits((entry >> 32) as u32)) - 2.0;
            if (least_on_rim - ROUNDING) * length > least {
                break;
            }
            let (caps, j) = (&self.caps, (entry & 0xffff_ffff) as usize);
            self.rims.open_corners(j, |k| {
                let Some(places) = corners_of(&caps[j], &caps[k]) else {
                    return;
                };
                for p in places {
                    let order = p.dot(wanted);
                    // Among equals, as in a regular packing, the one of the nearest neighbours.
                    let is_better = order < least || (order == least && j < of_rim);
                    if is_better && is_free(caps, &p) {
                        least_free = least_free.min(order);
                        if found(&(self.centre + p * self.radius)) {
                            (least, of_rim) = (order, j);
                        }
                    }
                }
            });
        }
        least_free
    }

    /// The smallest order that a free place other than a corner can have: at the place of smallest
    /// order of all, if it is free, or where the rim of a cap that covers that place has its
    /// smallest order. Infinite if none of these is free, and minus infinity if there are few caps.
    fn least_beside_corners(&self, wanted: &Vector3) -> f64 {
        let length = wanted.norm();
        // Beside few others it takes longer to find out than it saves.
        if self.caps.len() <= MANY || length == 0.0 {
            return f64::NEG_INFINITY;
        }
        let first = -wanted / length;
        if self.is_free(&first) {
            return -length;
        }
        let mut least = f64::INFINITY;
        for cap in &self.caps {
            let along = cap.axis.dot(&first);
            if along <= cap.rim {
                continue;
            }
            let across = first - cap.axis * along;
            let (sine, distance) = (cap.sine_squared.max(0.0).sqrt(), across.norm());
            let place = cap.axis * cap.rim + across * (sine / distance);
            let covers = |other: &Cap| other.axis.dot(&place) > other.rim + ROUNDING;
            // If the axis points at the first place, all places of the rim have the same order.
            if distance < ROUNDING || !self.caps.iter().any(covers) {
                least = least.min(-length * (cap.rim * along + sine * distance));
            }
        }
        least
    }

    /// The position of a point where two rims meet, that no cap covers and that `takes` accepts, if
    /// there is one.
    pub(crate) fn any_corner(
        &mut self,
        mut takes: impl FnMut(&Vector3) -> bool,
    ) -> Option<Vector3> {
        Arch::new().dispatch(
            #[inline(always)]
            || {
                let mut found = None;
                let mut j = 1;
                while found.is_none() && j < self.caps.len() {
                    let caps = &self.caps;
                    self.rims.open_corners(j, |k| {
                        let places = corners_of(&caps[j], &caps[k]);
                        for p in places.into_iter().flatten() {
                            let centre = self.centre + p * self.radius;
                            if found.is_none() && is_free(caps, &p) && takes(&centre) {
                                found = Some(centre);
                            }
                        }
                    });
                    j += 1;
                }
                found
            },
        )
    }

    /// The points where a wall touches the new sphere and a neighbour, covered or not. `towards` is
    /// the direction to the wall, `clearance` the distance of the wall from the front sphere's
    /// centre less the radius of the new sphere.
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

/// The two unit vectors where the rims of two caps meet at an angle, if they do: a foot in the
/// plane of the axes, offset to either side by a distance given by sin^2 sin^2 - (cosine - cos
/// cos)^2 >= 0.
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
