//! The parts of the rims of caps that no other cap covers, in single precision for `LANES` caps at
//! a time.
//!
//! A rim is a circle on the unit sphere. Another cap covers one arc of it. The circle is cut into
//! 64 sectors; a sector that lies within one such arc is covered, and once all 64 are, the rim
//! holds no corner of the free area. For most rims a few caps are enough. A place reported as
//! covered is covered. One reported as open may still be covered: the caller checks it in double
//! precision.

use crate::spheres::Vector3;

/// Number of caps processed at once, without a branch.
pub(crate) const LANES: usize = 8;
/// Numbers of `LANES` caps side by side.
type Lanes = [f32; LANES];

const SECTORS: f32 = 64.0;
/// Fraction of a sector by which an arc is shortened at either end: far more than the effect of
/// rounding.
const MARGIN: f32 = 0.02;
/// A corner is searched for this many sectors to either side of its apparent position.
const CORNER_MARGIN: f32 = 0.1;
/// Square of sine times sine below which the planes of two rims are so nearly parallel that
/// rounding could misplace their corners by more than that.
const BLUNT: f32 = 4e-4;
/// Square of the sine of half the angle below which an arc, shorter than about a sector, is
/// ignored.
const SHORT: f32 = 0.01;
/// Difference of cosines, squared, below which rims that pass each other may meet.
const NEARLY_MEET: f32 = 1e-5;

/// Stands for a position on a rim: the two rims do not meet.
const APART: f32 = -1.0;
/// Stands for a position on a rim: they may meet anywhere.
const ANYWHERE: f32 = -2.0;

/// Caps in groups of `LANES`: x, y, z of the axes and the cosines of the caps' angles. The last
/// group is padded with caps that cover nothing.
#[derive(Debug, Default)]
pub(crate) struct Rims {
    groups: Vec<[Lanes; 4]>,
    /// The cone around the caps of each group, if there are many: most are then far from a rim.
    cones: Vec<Cone>,
    /// For groups near the rim examined last, their number, and begin and end of the arcs in
    /// sectors.
    ends: Vec<(usize, [Lanes; 2])>,
}

/// A cone that holds all directions of some caps.
#[derive(Debug)]
struct Cone {
    axis: [f32; 3],
    /// Cosine and sine of its half angle.
    cosine: f32,
    sine: f32,
}

/// A cap, and two directions perpendicular to its axis from which positions on its rim are
/// measured.
struct Rim {
    axis: [f32; 3],
    across: [[f32; 3]; 2],
    cosine: f32,
    sine: f32,
    sine_squared: f32,
}

/// The arcs of a rim that the caps of one group cover.
struct Arcs {
    /// A bit for each sector.
    covered: u64,
    ends: [Lanes; 2],
}

impl Rims {
    pub(crate) fn clear(&mut self) {
        self.groups.clear();
        self.cones.clear();
    }

    /// Makes a cone around the caps of each group.
    pub(crate) fn enclose_groups(&mut self) {
        self.cones.extend(self.groups.iter().map(Cone::around));
    }

    /// Adds up to `LANES` caps: axis and cosine of the cap's angle.
    pub(crate) fn push(&mut self, caps: impl Iterator<Item = (Vector3, f64)>) {
        let mut group = [[0.0; LANES], [0.0; LANES], [0.0; LANES], [2.0; LANES]];
        for (lane, (axis, cosine)) in caps.enumerate() {
            let numbers = [axis.x, axis.y, axis.z, cosine];
            for (array, number) in group.iter_mut().zip(numbers) {
                array[lane] = number as f32;
            }
        }
        self.groups.push(group);
    }

    /// Calls `visit` with each cap k < `j` that may have a free corner with cap `j`.
    #[inline(always)]
    pub(crate) fn open_corners(&mut self, j: usize, mut visit: impl FnMut(usize)) {
        let Some(covered) = self.covered(j) else {
            return;
        };
        for (group, [from, to]) in &self.ends {
            for lane in 0..LANES.min(j.saturating_sub(group * LANES)) {
                let open = !covered & (around(from[lane]) | around(to[lane])) != 0;
                if from[lane] != APART && (from[lane] == ANYWHERE || open) {
                    visit(group * LANES + lane);
                }
            }
        }
    }

    /// True if no point of the rim of cap `j` is free.
    #[inline(always)]
    pub(crate) fn is_covered(&mut self, j: usize) -> bool {
        self.covered(j).is_none()
    }

    /// The sectors of the rim of cap `j` that are covered, and the ends of all arcs on it; none if
    /// all of it is covered.
    #[inline(always)]
    fn covered(&mut self, j: usize) -> Option<u64> {
        let rim = self.rim(j);
        let mut covered = 0;
        self.ends.clear();
        for (number, group) in self.groups.iter().enumerate() {
            if self.cones.get(number).is_some_and(|cone| cone.misses(&rim)) {
                continue;
            }
            let arcs = rim.arcs(group);
            covered |= arcs.covered;
            if covered == u64::MAX {
                return None;
            }
            self.ends.push((number, arcs.ends));
        }
        Some(covered)
    }

    #[inline(always)]
    fn rim(&self, j: usize) -> Rim {
        let [x, y, z, cosine] = self.groups[j / LANES].map(|array| array[j % LANES]);
        // Duff et al. 2017, Building an orthonormal basis, revisited.
        let sign = 1.0_f32.copysign(z);
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        let sine_squared = 1.0 - cosine * cosine;
        Rim {
            axis: [x, y, z],
            across: [
                [1.0 + sign * x * x * a, sign * b, -sign * x],
                [b, sign + y * y * a, -y],
            ],
            cosine,
            sine: sine_squared.max(0.0).sqrt(),
            sine_squared,
        }
    }
}

impl Cone {
    /// The cone around the caps of a group.
    fn around([x, y, z, cosine]: &[Lanes; 4]) -> Self {
        // Those that stand for no cap have no axis.
        let sum = [x, y, z].map(|lanes| lanes.iter().sum::<f32>());
        let length = (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]).sqrt();
        if length < 0.1 {
            return Self::everywhere();
        }
        let axis = sum.map(|s| s / length);
        let (mut apart, mut widest) = (1.0_f32, 1.0_f32);
        for k in (0..LANES).filter(|k| cosine[*k] <= 1.0) {
            apart = apart.min(axis[0] * x[k] + axis[1] * y[k] + axis[2] * z[k]);
            widest = widest.min(cosine[k]);
        }
        let sine = |cosine: f32| (1.0 - cosine * cosine).max(0.0).sqrt();
        Self {
            axis,
            cosine: apart * widest - sine(apart) * sine(widest),
            sine: sine(apart) * widest + apart * sine(widest),
        }
    }

    /// A cone that holds all directions.
    fn everywhere() -> Self {
        Self {
            axis: [0.0; 3],
            cosine: -1.0,
            sine: 0.0,
        }
    }

    /// True if the rim certainly does not meet the cone.
    #[inline(always)]
    fn misses(&self, rim: &Rim) -> bool {
        const ROUNDING: f32 = 1e-3;
        let [x, y, z] = rim.axis;
        let between = self.axis[0] * x + self.axis[1] * y + self.axis[2] * z;
        let cosine = self.cosine * rim.cosine - self.sine * rim.sine;
        let sine = self.sine * rim.cosine + self.cosine * rim.sine;
        // The sum of the two angles is less than half a turn.
        self.sine > 0.0 && sine > 0.0 && between < cosine - ROUNDING
    }
}

impl Rim {
    /// True if the point of this rim in direction p, in the plane perpendicular to its axis, is
    /// covered by a cap with axis (along, u, v): p . (u, v) sine > t, with t = cosine of that cap -
    /// along * cosine of this one.
    #[inline(always)]
    fn arcs(&self, [x, y, z, cosine]: &[Lanes; 4]) -> Arcs {
        let dot = |a: &[f32; 3], k: usize| a[0] * x[k] + a[1] * y[k] + a[2] * z[k];
        let (mut begin, mut end) = ([[0.0; LANES]; 2], [[0.0; LANES]; 2]);
        let mut kind = [0.0; LANES];
        let (mut length, mut whole) = ([0_i32; LANES], [0_u64; LANES]);
        let mut first = [0_i32; LANES];
        let mut ends = [[0.0; LANES]; 2];
        let mut masks = [0_u64; LANES];
        for k in 0..LANES {
            let (u, v) = (dot(&self.across[0], k), dot(&self.across[1], k));
            let t = cosine[k] - dot(&self.axis, k) * self.cosine;
            let reach_squared = self.sine_squared * (u * u + v * v);
            let off_squared = reach_squared - t * t;
            let off = if off_squared > 0.0 { off_squared } else { 0.0 }.sqrt();
            begin[0][k] = u * t + v * off;
            begin[1][k] = v * t - u * off;
            end[0][k] = u * t - v * off;
            end[1][k] = v * t + u * off;
            let apart = off_squared < -NEARLY_MEET;
            let blunt = reach_squared < BLUNT;
            kind[k] = if apart {
                APART
            } else if blunt {
                ANYWHERE
            } else {
                0.0
            };
            whole[k] = if apart & (t < 0.0) { u64::MAX } else { 0 };
            length[k] = if (off_squared > SHORT * reach_squared) & !blunt {
                63
            } else {
                0
            };
        }
        for k in 0..LANES {
            let from = position(begin[0][k], begin[1][k]);
            let to = position(end[0][k], end[1][k]);
            let after = if to < from { to + SECTORS } else { to };
            first[k] = nearest_integer(from + MARGIN + 0.5);
            let sectors = nearest_integer(after - MARGIN + 0.5) - 1 - first[k];
            let sectors = if sectors > 0 { sectors } else { 0 };
            length[k] = if sectors < length[k] {
                sectors
            } else {
                length[k]
            };
            ends[0][k] = if kind[k] < 0.0 { kind[k] } else { from };
            ends[1][k] = to;
        }
        for k in 0..LANES {
            let arc = (1_u64 << length[k]) - 1;
            masks[k] = arc.rotate_left(first[k] as u32 & 63) | whole[k];
        }
        Arcs {
            covered: masks.iter().fold(0, |all, mask| all | mask),
            ends,
        }
    }
}

/// Position of a direction on the circle, in sectors: grows monotonically with its angle, but not
/// uniformly.
#[inline(always)]
fn position(x: f32, y: f32) -> f32 {
    let sum = x.abs() + y.abs();
    let fraction = x / if sum > 1e-30 { sum } else { 1e-30 };
    0.25 * SECTORS
        * if y < 0.0 {
            3.0 + fraction
        } else {
            1.0 - fraction
        }
}

/// The integer nearest to x, 0 <= x < 2^22: in single precision the last bit of x + 2^23 is worth
/// 1.
#[inline(always)]
fn nearest_integer(x: f32) -> i32 {
    (x + 8_388_608.0).to_bits() as i32 & 0x7f_ffff
}

/// The sectors within `CORNER_MARGIN` of a position.
#[inline(always)]
fn around(position: f32) -> u64 {
    let bit = |at: f32| 1_u64 << (at as u32 & 63);
    bit(position + SECTORS - CORNER_MARGIN) | bit(position + CORNER_MARGIN)
}
