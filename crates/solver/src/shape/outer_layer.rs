//! The spheres of a union that can be touched from outside, and by what.
//!
//! What touches a sphere and holds a ball of some radius close to where it does so has the centre
//! of that ball in reach of the sphere. ContactSphere centres come from outside, and cannot get
//! where the other spheres, grown by the radius of the ball, leave no way: over a closed surface
//! around the sphere that these hide all over.

use nalgebra::Vector3;

use super::caps::{Arc, Cap, Hidden, free_arcs, hidden, prune};
use super::cells::Cells;

/// A sphere of a clump is left out if it is hidden even when it grows by this share of its radius:
/// what touches the clump overlaps it by less.
pub const HIDDEN: f64 = 0.05;

/// Of the smallest sphere that clumps can meet, the share that balls have which cannot get in: less
/// than 1, for edges and corners are further from such balls.
pub const FRACTION_OF_SMALLEST: f64 = 0.7;

/// How far the centre of a ball is from the corner of three walls at right angles that it touches
/// from within, in its radii. For edges and faces it is less.
const TO_CORNER: f64 = 1.732_050_807_568_877_2;

/// Free arcs narrower than this, rad, are rounding: circles of three spheres through one point
/// leave some.
const LEAST_ARC_RAD: f64 = 1e-12;

/// Spheres nearer than this to each other and to one radius, in radii, are equal spheres in the
/// same place.
const SAME: f64 = 1e-12;

/// The indices, rising, of the spheres that can be touched by balls of at least the radius
/// `ball_m`, m, and by what has corners no sharper than a cube and room for such a ball in each.
/// With 0: by anything, however sharp. Those left out stay so if they grow by `margin` times their
/// radius; the others stay as they are.
///
/// `centres_m` and `radii_m`, m, have one entry per sphere; entries without a partner are left out.
/// A sphere of which nothing but single points can be touched does not count. Of equal spheres in
/// the same place, only the first counts.
///
/// The test is exact to rounding, without samples: the other balls hide caps of the surface around
/// a sphere, and some of it is free if and only if an arc of the edge of some cap lies in no other
/// cap, or if there is no cap at all.
///
/// Spheres around a void inside the body in which a ball has room count as outer too, although
/// nothing from outside reaches them. The time is best for radii within some tens of each other, as
/// the neighbours are searched in cells as wide as the largest pair.
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

/// The spheres, and room for the work on one of them.
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
