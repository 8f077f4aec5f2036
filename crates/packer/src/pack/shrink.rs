//! First step: the fraction by which the front's radii are reduced, so that it leaves as much room
//! as settling needs and no more.
//!
//! Far from walls, spheres of the sizes used here jam, settled in random order, at `0.630 + 0.066
//! s + 0.086 k s^2` of the volume, with the standard deviation over mean s and the skewness k of
//! their diameters: the form of Desmond and Weeks 2014 (Phys. Rev. E 90, 022204), whose 0.634 for
//! one size this settling does not quite reach. Walls reduce it by 0.080 times mean diameter times
//! surface over volume. This was fitted to bars, balls, discs, rocks and tori, 6 to 40 diameters
//! thick, of one size, uniform and lognormal diameters: it separates jamming bodies from others
//! within 0.5 %. Of wider distributions a few large spheres fill most of the volume: they jam at
//! about 0.676, and walls count by the mean diameter by mass.

use super::settings::PackSettings;
use crate::sizes::Sizes;
use crate::spheres::{ReducedSphere, Vector3};
use dem_io::Surface;

/// Volume fraction at which a single size jams, and the contributions of spread and skewness.
const JAMMED: [f64; 3] = [0.6304, 0.0658, 0.0857];
/// Reduction of the volume fraction by walls, per mean diameter times surface over volume.
const WALL: f64 = 0.080;
/// Spread above which a distribution is wide, and the volume fraction at which it jams.
const WIDE: f64 = 0.4;
const WIDE_JAMMED: f64 = 0.676;
/// Reduction of the front's radii to begin with for a wide distribution.
const WIDE_SHRINK: f64 = 0.0435;
/// Target distance below jamming, as a fraction of the jamming density. Nearer, settling takes two
/// to three times the steps.
const BELOW_JAMMING: f64 = 0.006;
/// Accepted deviations of a front from the target: the surplus, which is taken out, and what may be
/// missing. Another front aims at a surplus.
const MOST_SURPLUS: f64 = 0.03;
const MOST_MISSING: f64 = 0.005;
const AIM: f64 = 0.006;
/// Smallest and largest reduction of the front's radii that is chosen automatically.
pub(crate) const SHRINK_RANGE: [f64; 2] = [0.02, 0.08];

/// The target volume of spheres in a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FillTarget {
    /// Volume of the spheres at their reduced radii, in local units.
    pub volume: f64,
}

impl FillTarget {
    /// Just short of jamming in a shape, for spheres that touch at radius / (1 + overlap) but keep
    /// their full radius from the wall.
    pub fn new(surface: &Surface, sizes: &Sizes, overlap: f64) -> Self {
        let area: f64 = (0..surface.triangles.len())
            .map(|n| {
                let [a, b, c] = surface.corners(n).map(Vector3::from);
                0.5 * (b - a).cross(&(c - a)).norm()
            })
            .sum();
        let volume = surface.volume_m3() / surface.unit_m.powi(3);
        let diameter = sizes.mean_m() / surface.unit_m / (1.0 + overlap);
        // The region that reduced spheres can reach ends half the overlap below the surface.
        let reached = (volume - 0.5 * overlap * diameter * area).max(0.0);
        let [spread, skewness] = sizes.spread_and_skewness();
        let (far, at_wall) = if spread > WIDE {
            (WIDE_JAMMED, sizes.mean_by_mass_m() / sizes.mean_m())
        } else {
            let far = JAMMED[0] + JAMMED[1] * spread + JAMMED[2] * skewness * spread * spread;
            (far, 1.0)
        };
        let jammed = far * reached - WALL * at_wall * diameter * area;
        Self {
            volume: (1.0 - BELOW_JAMMING) * jammed.max(0.0),
        }
    }

    /// A better reduction of the radii for a front whose radii were reduced by `shrink` and whose
    /// spheres will have the volume `filled` at their reduced radii, in local units; none if that
    /// is good enough.
    pub fn better_shrink(&self, shrink: f64, filled: f64) -> Option<f64> {
        let surplus = filled / self.volume - 1.0;
        if (-MOST_MISSING..=MOST_SURPLUS).contains(&surplus) {
            return None;
        }
        let better = 1.0 - (1.0 - shrink) * ((1.0 + surplus) / (1.0 + AIM)).cbrt();
        let better = better.clamp(SHRINK_RANGE[0], SHRINK_RANGE[1]);
        (better != shrink).then_some(better)
    }

    /// The part of the spheres of a front that is left out, since they are too many for the volume
    /// that they will have at their reduced radii, local units: at most the accepted surplus. In
    /// shapes so thin that the target means little, more would take the body apart.
    pub fn too_many(&self, filled: f64) -> f64 {
        let most = MOST_SURPLUS / (1.0 + MOST_SURPLUS);
        (1.0 - self.volume / filled).clamp(0.0, most)
    }
}

/// Takes out this part of the spheres, at equal distances along the list: evenly in space if the
/// list follows a curve through it, and without regard to size. Returns the number taken out.
pub(super) fn thin_out(spheres: &mut Vec<ReducedSphere>, part: f64) -> usize {
    let before = spheres.len();
    let mut owed = 0.5;
    spheres.retain(|_| {
        owed += part;
        let is_kept = owed < 1.0;
        if !is_kept {
            owed -= 1.0;
        }
        is_kept
    });
    before - spheres.len()
}

/// True if a few large spheres fill most of the volume, so that fronts of the same settings differ
/// by more than what will do.
pub(super) fn is_wide(sizes: &Sizes) -> bool {
    sizes.spread_and_skewness()[0] > WIDE
}

/// The reduction to begin with: the user's, or else one that leaves most bodies a small surplus.
pub(super) fn choose_shrink(settings: &PackSettings) -> f64 {
    let usual = || {
        if is_wide(&settings.sizes) {
            return WIDE_SHRINK;
        }
        let [spread, _] = settings.sizes.spread_and_skewness();
        (0.045 - 0.05 * spread).max(SHRINK_RANGE[0])
    };
    rounded(settings.densify.unwrap_or_else(usual))
}

/// Rounded to millionths, for the same reason as the radii.
pub(super) fn rounded(shrink: f64) -> f64 {
    (1e6 * shrink).round() * 1e-6
}
