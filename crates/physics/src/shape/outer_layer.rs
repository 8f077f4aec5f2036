//! The outer spheres of a union: those that can be touched from outside by objects of a given
//! bluntness.
//!
//! If an object touches a sphere and has room for a ball of some radius near the point of contact,
//! the centre of that ball is within reach of the sphere. Ball centres come from outside, and
//! cannot enter where the other spheres, grown by the radius of the ball, leave no gap: through a
//! closed surface around the sphere that these cover completely.

use nalgebra::Vector3;

use super::caps::{Arc, Cap, Hidden, free_arcs, hidden, prune};
use super::cells::Cells;

/// A sphere of a clump is an inner one if it is hidden even when grown by this fraction of its
/// radius: objects that touch the clump overlap it by less.
pub const HIDDEN: f64 = 0.05;

/// Radius of balls that cannot enter, as a fraction of that of the smallest sphere that clumps can
/// meet: less than 1, as edges and corners are farther from such balls.
pub const FRACTION_OF_SMALLEST: f64 = 0.7;

/// Distance of the centre of a ball from the corner of three walls at right angles that it touches
/// from within, in its radii. For edges and faces it is less.
const TO_CORNER: f64 = 1.732_050_807_568_877_2;

/// Free arcs narrower than this, rad, are rounding: circles of three spheres through one point
/// leave some.
const LEAST_ARC_RAD: f64 = 1e-12;

/// Spheres whose positions and radii differ by less than this, in radii, are equal spheres at the
/// same position.
const SAME: f64 = 1e-12;

/// The indices, ascending, of the spheres that can be touched by balls of at least the radius
/// `ball_m`, m, and by objects whose corners are no sharper than those of a cube and have room for
/// such a ball. With 0: by any object, however sharp. Inner spheres remain inner if they grow by
/// `margin` times their radius while the others do not.
///
/// `centres_m` and `radii_m`, m, have one entry per sphere; entries without a counterpart are
/// ignored. A sphere that can only be touched at single points does not count. Of equal spheres at
/// the same position, only the first counts.
///
/// The test is exact to rounding, without sampling: the other balls hide caps of the surface around
/// a sphere, and a part of it is free if and only if an arc of the edge of some cap lies in no
/// other cap, or if there is no cap at all.
///
/// Spheres around a void inside the body with room for a ball also count as outer ones, although
/// nothing from outside reaches them. It is fastest for radii within a factor of some tens, as the
/// neighbours are searched in cells as wide as the largest pair.
pub fn outer_layer(centres_m: &[[f64; 3]], radii_m: &[f64], margin: f64, ball_m: f64) -> Vec<u32> {
    let count = centres_m.len().min(radii_m.len());
    let (centres_m, radii_m) = (&centres_m[..count], &radii_m[..count]);
    let largest_m = radii_m.iter().fold(0.0_f64, |most, &r| most.max(r));
    let between_m = (2.0 + margin.max(0.0)) * largest_m + (1.0 + TO_CORNER) * ball_m;
    let cells = Cells::new(centres_m, between_m);
    let mut layer = Layer {
        centres_m,
        radii_m,
        margin,
        ball_m,
        near: Vec::new(),
        caps: Vec::new(),
        free: Vec::new(),
    };
    (0_u32..)
        .zip(centres_m)
        .filter(|(i, centre)| {
            cells.near(centre, &mut layer.near);
            layer.is_outer(*i)
        })
        .map(|(i, _)| i)
        .collect()
}

/// The spheres, and buffers for the work on one of them.
struct Layer<'a> {
    centres_m: &'a [[f64; 3]],
    radii_m: &'a [f64],
    margin: f64,
    ball_m: f64,
    near: Vec<u32>,
    caps: Vec<Cap>,
    free: Vec<Arc>,
}

impl Layer<'_> {
    fn is_outer(&mut self, i: u32) -> bool {
        let centre = Vector3::from(self.centres_m[i as usize]);
        let radius = self.radii_m[i as usize];
        let grown = radius * (1.0 + self.margin) + TO_CORNER * self.ball_m;
        self.caps.clear();
        for &j in self.near.iter().filter(|&&j| j != i) {
            let offset = Vector3::from(self.centres_m[j as usize]) - centre;
            let other = self.radii_m[j as usize];
            if (other - radius).abs() <= SAME * radius && offset.norm() <= SAME * radius {
                if j < i {
                    return false;
                }
                continue;
            }
            match hidden(grown, offset, other + self.ball_m, false) {
                Hidden::Nothing => {}
                Hidden::Part(cap) => self.caps.push(cap),
                Hidden::All => return false,
            }
        }
        if self.caps.is_empty() {
            return true;
        }
        prune(&mut self.caps)
            && (0..self.caps.len()).any(|circle| {
                free_arcs(&self.caps, circle, &mut self.free);
                self.free.iter().any(|[from, to]| to - from > LEAST_ARC_RAD)
            })
    }
}
