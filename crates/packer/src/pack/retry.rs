//! The policy of retries: when a packing is started again, and with which settings. No other part
//! of the packer retries.
//!
//! - A bare front that fills voids may distort the sizes: the next one holds back the sizes in
//!   surplus.
//! - A front before settling may leave too much room, or far too little, since small bodies vary by
//!   chance. The next one runs at other radii. If it leaves a little too little, spheres are taken
//!   out evenly. So they are while settling if they jam.
//!
//! - Sizes that differ much may end a front early: a large one that fits nowhere any more stops it.
//!   If the last front leaves far too little, spheres are scattered at random instead.
//!
//! If the reduction of the radii was given by the user, only the sizes of a bare front are retried.

use super::attempt::{Attempt, can_fill_voids};
use super::grow::Grown;
use super::job::Job;
use super::settle::WhenJammed;
use super::shrink::{FillTarget, is_wide, rounded};
use crate::sizes::Sizes;

/// Surplus of small spheres in a bare front up to which voids are filled, in square roots of the
/// number of spheres. The first attempts allow many times the effect of chance, to learn the number
/// of voids (10 in a ball of half a million spheres, less in all other shapes that can be filled).
/// The last attempt allows a third of the effect of chance, whatever voids remain.
const MOST_TOO_MANY: [f64; 2] = [20.0, 0.5];
/// Largest number of bare fronts.
const MOST_BARE_FRONTS: usize = 9;
/// Largest error of the number of spheres up to any size, in square roots of the number of spheres,
/// for which a bare front is kept: half the effect of chance, after some attempts two thirds.
const MOST_IMBALANCE: [f64; 2] = [0.68, 0.9];
const STRICT_ATTEMPTS: usize = 4;
/// The next attempt is the last one if the error, in square roots of the number of spheres, is
/// larger than this (the effect of chance) and has not fallen below the second fraction of the
/// previous error: an imbalance of this size that can be corrected falls to a third or less each
/// time.
const HOPELESS_IMBALANCE: f64 = 1.36;
const SLOWEST_FALL: f64 = 0.6;

/// Largest number of fronts until one leaves the room that settling needs, and of sizes that are
/// wide.
const MOST_FRONTS: usize = 4;
const MOST_WIDE_FRONTS: usize = 1;

/// Ratio of the largest to the smallest size from which on large ones stop a front, and the part of
/// the target volume below which it has stopped early.
const LARGE_STOP: f64 = 3.0 * (1.0 - 1e-9);
const STOPPED_EARLY: f64 = 0.95;

/// The attempts made, and those still allowed.
pub(super) struct Retry {
    /// The target volume, if the reduction is chosen here.
    target: Option<FillTarget>,
    /// Largest number of fronts until one leaves the room that settling needs.
    most_fronts: usize,
    /// Number of fronts run.
    pub(super) fronts: usize,
    /// True if this bare front is the last one.
    is_last: bool,
    last_imbalance: f64,
}

impl Retry {
    /// The policy for a packing.
    pub(super) fn new(job: &Job) -> Self {
        let settings = job.settings;
        let target = || FillTarget::new(job.solid.surface, &settings.sizes, settings.overlap);
        Self {
            target: settings.densify.is_none().then(target),
            most_fronts: if is_wide(&settings.sizes) {
                MOST_WIDE_FRONTS
            } else {
                MOST_FRONTS
            },
            fronts: 0,
            is_last: false,
            last_imbalance: f64::INFINITY,
        }
    }

    /// The first attempt.
    pub(super) fn first(shrink: f64, sizes: &Sizes) -> Attempt {
        Attempt {
            shrink,
            fills_voids: shrink == 0.0 && can_fill_voids(sizes),
            expected: None,
            most_too_many: MOST_TOO_MANY[0],
            quota: None,
        }
    }

    /// The attempt to make if the front of this one is not good enough.
    pub(super) fn after_front(&mut self, attempt: &Attempt, grown: &Grown) -> Option<Attempt> {
        self.fronts += 1;
        if attempt.fills_voids {
            return self.with_truer_sizes(attempt, grown);
        }
        if self.fronts >= self.most_fronts {
            return None;
        }
        let shrink = self.target?.better_shrink(attempt.shrink, grown.volume())?;
        Some(Attempt {
            shrink: rounded(shrink),
            ..attempt.clone()
        })
    }

    /// The part of the spheres of a front that is too many for settling, 0 to 1.
    pub(super) fn too_many(&self, grown: &Grown) -> f64 {
        (self.target.as_ref()).map_or(0.0, |target| target.too_many(grown.volume()))
    }

    /// The volume to scatter at random (reduced radii, local units) if this front, the last one,
    /// has stopped early.
    pub(super) fn volume_to_scatter(&self, sizes: &Sizes, grown: &Grown) -> Option<f64> {
        let target = self.target?.volume;
        let stopped_early = grown.volume() < STOPPED_EARLY * target;
        (stopped_early && sizes.max_m() >= LARGE_STOP * sizes.min_m()).then_some(target)
    }

    /// Treatment of spheres that jam.
    pub(super) fn when_jammed(&self) -> WhenJammed {
        if self.target.is_some() {
            WhenJammed::ThinOut
        } else {
            WhenJammed::TakeOut
        }
    }

    /// A bare front that holds back the sizes in surplus in this one, unless the sizes are correct.
    fn with_truer_sizes(&mut self, attempt: &Attempt, grown: &Grown) -> Option<Attempt> {
        let quota = grown.quota()?;
        let placed = grown.spheres() as f64;
        let imbalance = quota.imbalance() / placed.sqrt();
        let most_imbalance = MOST_IMBALANCE[usize::from(self.fronts > STRICT_ATTEMPTS)];
        if self.is_last || (imbalance < most_imbalance && !grown.has_left_voids()) {
            return None;
        }
        // If too few small spheres can be held back for all voids, more attempts would not help.
        let is_hopeless = self.fronts == 1 && grown.has_left_voids()
            || imbalance > HOPELESS_IMBALANCE.max(SLOWEST_FALL * self.last_imbalance);
        self.is_last = is_hopeless || self.fronts + 1 == MOST_BARE_FRONTS;
        self.last_imbalance = imbalance;
        Some(Attempt {
            expected: Some(placed),
            most_too_many: MOST_TOO_MANY[usize::from(self.is_last)],
            // Nothing is held back if voids remain anyway.
            quota: (!self.is_last).then(|| quota.corrected()),
            ..attempt.clone()
        })
    }
}
