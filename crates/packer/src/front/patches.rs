//! A search for a free place on a halo, for walls of any shape: the halo is divided into patches,
//! and those into smaller ones, as long as neither a cap nor the wall is certain to cover them.

use super::halo::Halo;
use crate::spheres::Vector3;

/// The part of a patch, enclosed in a ball around its middle, that the wall leaves free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Wall {
    /// Nothing is free.
    Covers,
    /// The middle is free, and perhaps more.
    LeavesMiddle,
    /// The middle is not free, but other parts may be.
    Cuts,
}

/// Patches smaller than this fraction of the halo's radius count as covered.
const SMALLEST: f64 = 1e-6;
/// Largest number of patches examined: their number grows without limit where an entire seam is
/// just too narrow.
const MOST: usize = 10_000;

/// A triangle on the unit sphere.
type Patch = [Vector3; 3];

impl Halo {
    /// A place that no neighbour's cap and no wall covers, if there is one. `wall` gives the part
    /// that the wall leaves of a ball (centre and radius in local units).
    pub(crate) fn free_place(&self, wall: impl Fn(&Vector3, f64) -> Wall) -> Option<Vector3> {
        let mut patches: Vec<Patch> = octahedron().collect();
        let mut looked_at = 0;
        while let Some(patch) = patches.pop() {
            looked_at += 1;
            let [a, b, c] = patch;
            let middle = (a + b + c).normalize();
            let cosine = patch
                .iter()
                .map(|corner| corner.dot(&middle))
                .fold(1.0, f64::min);
            let sine = (1.0 - cosine * cosine).sqrt();
            // The longest chord from the middle is 2 sin(angle / 2).
            let reach = self.radius * (2.0 - 2.0 * cosine).sqrt();
            let mut middle_is_free = true;
            let covered = self.caps.iter().any(|cap| {
                let along = cap.axis.dot(&middle);
                middle_is_free &= along <= cap.rim;
                cosine >= cap.rim && along > cap.rim * cosine + cap.sine_squared.sqrt() * sine
            });
            if covered {
                continue;
            }
            let centre = self.position(&middle);
            match wall(&centre, reach) {
                Wall::Covers => continue,
                Wall::LeavesMiddle if middle_is_free => return Some(centre),
                _ => {}
            }
            if reach > SMALLEST * self.radius && looked_at < MOST {
                let [ab, bc, ca] = [a + b, b + c, c + a].map(|v| v.normalize());
                patches.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            }
        }
        None
    }
}

fn octahedron() -> impl Iterator<Item = Patch> {
    (0..8).map(|octant| {
        [0, 1, 2].map(|k| {
            let mut corner = Vector3::zeros();
            corner[k] = if octant >> k & 1 == 0 { 1.0 } else { -1.0 };
            corner
        })
    })
}
