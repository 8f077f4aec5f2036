//! The arrangement of circles that other balls cut on a sphere: the caps that they hide and the
//! arcs of the circles that remain free.
//!
//! Two circles are always compared in the same order and have the same points of intersection for
//! both, so that rounding never leaves gaps in the edge of the free part.

use std::f64::consts::TAU;

use nalgebra::Vector3;

/// The part of a sphere that a ball hides.
pub(super) enum Hidden {
    /// No part with an area.
    Nothing,
    /// A cap.
    Part(Cap),
    /// The entire sphere.
    All,
}

/// A cap of the unit sphere: the points u with `axis . u > cosine`.
pub(super) struct Cap {
    /// Unit vector to the middle of the cap.
    pub axis: Vector3<f64>,
    /// Cosine of the angular radius.
    pub cosine: f64,
    /// Sine of the angular radius, positive.
    pub sine: f64,
    /// Directions at the angles 0 and 90 degrees on the circle, right-handed with the axis.
    pub across: [Vector3<f64>; 2],
}

/// An arc of a circle: the angles from the first up to the second, rad, within 0 to 2 pi.
pub(super) type Arc = [f64; 2];

/// Relative position of two circles on a sphere.
enum Meeting {
    /// Neither cap hides any of the other circle.
    Apart,
    /// The cap of the first circle lies in the other.
    FirstInside,
    /// The cap of the second circle lies in the other.
    SecondInside,
    /// Together the two caps cover the sphere.
    HideAll,
    /// The circles cross.
    Cross(Crossing),
}

/// Two circles that cross.
struct Crossing {
    /// Unit vector perpendicular to both axes.
    side: Vector3<f64>,
    /// Sine and cosine of the angle between the axes.
    between: [f64; 2],
    /// Sine and cosine of half the arc that the second cap hides of the first circle.
    half: [f64; 2],
}

/// The part of the sphere of radius `radius_m` around the origin that is hidden by the ball of
/// radius `other_m` with its centre at `offset_m`, m.
///
/// A ball at the same position hides the sphere if it is larger, or if it is equal and `rules`.
pub(super) fn hidden(radius_m: f64, offset_m: Vector3<f64>, other_m: f64, rules: bool) -> Hidden {
    let far = offset_m.norm();
    if far == 0.0 {
        let over = other_m > radius_m || (other_m == radius_m && rules);
        return if over { Hidden::All } else { Hidden::Nothing };
    }
    // 1 minus the cosine of the angular radius, and 1 plus it: as products, as both can be small.
    let double = 2.0 * far * radius_m;
    let less = (other_m - far + radius_m) * (other_m - radius_m + far) / double;
    let more = (radius_m - other_m + far) * (far + radius_m + other_m) / double;
    if !(less > 0.0 && less.is_finite() && more.is_finite()) {
        return Hidden::Nothing;
    }
    if more <= 0.0 {
        return Hidden::All;
    }
    Hidden::Part(Cap::new(offset_m / far, less, more))
}

impl Cap {
    fn new(axis: Vector3<f64>, less: f64, more: f64) -> Self {
        let first = Vector3::ith(axis.iamin(), 1.0).cross(&axis).normalize();
        Self {
            axis,
            cosine: 0.5 * (more - less),
            sine: (less * more).sqrt(),
            across: [first, axis.cross(&first)],
        }
    }

    /// The angle of a direction on the circle, rad.
    fn angle(&self, direction: &Vector3<f64>) -> f64 {
        let [first, second] = &self.across;
        second.dot(direction).atan2(first.dot(direction))
    }
}

/// Relative position of the circles of two caps; the first has the smaller circle, on which the
/// points of intersection are most accurate.
fn meet(a: &Cap, b: &Cap) -> Meeting {
    let across = a.axis.cross(&b.axis);
    let sine = across.norm();
    let cosine = a.axis.dot(&b.axis);
    // cos(b) - cos(between) cos(a), without cancellation for nearly parallel axes.
    let excess = if cosine > 0.0 {
        b.cosine - a.cosine + 0.5 * a.cosine * (a.axis - b.axis).norm_squared()
    } else {
        b.cosine + a.cosine - 0.5 * a.cosine * (a.axis + b.axis).norm_squared()
    };
    let reach = sine * a.sine;
    let one_side = cosine > a.cosine * b.cosine;
    if excess >= reach && one_side {
        Meeting::SecondInside
    } else if excess >= reach {
        Meeting::Apart
    } else if excess <= -reach && one_side {
        Meeting::FirstInside
    } else if excess <= -reach {
        Meeting::HideAll
    } else {
        let half = excess / reach;
        Meeting::Cross(Crossing {
            side: across / sine,
            between: [sine, cosine],
            half: [((1.0 - half) * (1.0 + half)).sqrt(), half],
        })
    }
}

impl Crossing {
    /// The middle and half the width of the arc that the second cap hides of the first circle, rad.
    fn hidden_on_first(&self, a: &Cap) -> [f64; 2] {
        let toward = self.side.cross(&a.axis);
        [a.angle(&toward), self.half[0].atan2(self.half[1])]
    }

    /// The same for the first cap and the second circle, with the same two points as ends.
    fn hidden_on_second(&self, a: &Cap, b: &Cap) -> [f64; 2] {
        let toward = b.axis.cross(&self.side);
        let [sine, cosine] = self.between;
        let along = a.cosine * sine - a.sine * self.half[1] * cosine;
        [b.angle(&toward), (a.sine * self.half[0]).atan2(along)]
    }
}

/// Sorts the caps, the largest first, and removes those inside others; of equal ones it keeps the
/// first. False if two caps together cover the sphere.
pub(super) fn prune(caps: &mut Vec<Cap>) -> bool {
    caps.sort_by(|a, b| a.cosine.total_cmp(&b.cosine));
    let mut kept: Vec<Cap> = Vec::with_capacity(caps.len());
    'caps: for cap in caps.drain(..) {
        for larger in &kept {
            let (a, b) = if cap.sine < larger.sine {
                (&cap, larger)
            } else {
                (larger, &cap)
            };
            // Certainly apart or crossing.
            if a.axis.dot(&b.axis) <= a.cosine * b.cosine && a.cosine + b.cosine > 0.0 {
                continue;
            }
            match meet(a, b) {
                Meeting::FirstInside | Meeting::SecondInside => continue 'caps,
                Meeting::HideAll => return false,
                Meeting::Apart | Meeting::Cross(_) => {}
            }
        }
        kept.push(cap);
    }
    *caps = kept;
    true
}

/// Puts into `free` the arcs of a circle that lie in no other cap, for caps after [`prune`]. An arc
/// across the angle 0 is split in two.
pub(super) fn free_arcs(caps: &[Cap], circle: usize, free: &mut Vec<Arc>) {
    free.clear();
    free.push([0.0, TAU]);
    let own = &caps[circle];
    for (k, other) in caps.iter().enumerate() {
        if k == circle {
            continue;
        }
        let first = own.sine < other.sine || (own.sine == other.sine && circle < k);
        let (a, b) = if first { (own, other) } else { (other, own) };
        let Meeting::Cross(crossing) = meet(a, b) else {
            continue;
        };
        let [middle, half] = if first {
            crossing.hidden_on_first(a)
        } else {
            crossing.hidden_on_second(a, b)
        };
        let from = (middle - half).rem_euclid(TAU);
        let to = from + 2.0 * half;
        take_away(free, [from, to]);
        if to > TAU {
            take_away(free, [0.0, to - TAU]);
        }
        if free.is_empty() {
            return;
        }
    }
}

fn take_away(free: &mut Vec<Arc>, gone: Arc) {
    let mut i = 0;
    while i < free.len() {
        let [from, to] = free[i];
        let before = [from, to.min(gone[0])];
        let after = [from.max(gone[1]), to];
        match (before[0] < before[1], after[0] < after[1]) {
            (true, true) => {
                free[i] = before;
                free.insert(i + 1, after);
                i += 2;
            }
            (true, false) => {
                free[i] = before;
                i += 1;
            }
            (false, true) => {
                free[i] = after;
                i += 1;
            }
            (false, false) => {
                free.remove(i);
            }
        }
    }
}
