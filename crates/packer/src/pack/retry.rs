//! The policy of retries: when a packing is begun again, and with what. The only place of the
//! packer that tries again.
//!
//! - A bare front that fills voids may distort the sizes: the next one keeps back those that were
//!   too many.
//! - A front before settling may leave too much room or too little: in small bodies it differs by
//!   chance. The next one runs at other radii.
//! - Its spheres may jam all the same: the next front runs at radii that are less smaller.
//!
//! If the fraction by which radii are smaller was asked for, nothing is tried again but the sizes
//! of a bare front.

use super::attempt::{Attempt, can_fill_voids};
use super::grow::Grown;
use super::job::Job;
use super::settle::{Settled, WhenJammed};
use super::shrink::{FillTarget, rounded};
use crate::sizes::Sizes;

/// Surplus of small spheres in a bare front up to which voids are filled, in roots of the number of
/// spheres: at first many times what chance does, to learn how many voids there are (10 in a ball
/// of half a million spheres, less in all else that can be filled); in the last attempt a third of
/// it, whatever voids that leaves.
const MOST_TOO_MANY: [f64; 2] = [20.0, 0.5];
/// Bare fronts at most.
const MOST_BARE_FRONTS: usize = 9;
/// A bare front is kept if the number of spheres up to any size is off by less than this many roots
/// of the number of spheres: half of what chance does, after some attempts two thirds.
const MOST_IMBALANCE: [f64; 2] = [0.68, 0.9];
const STRICT_ATTEMPTS: usize = 4;
/// The next attempt is the last one where the number is off by more than so many roots, what chance
/// does, and by more than this part of what it was off by in the attempt before: what can be evened
/// out falls to a third or less while it is that much.
const HOPELESS_IMBALANCE: f64 = 1.36;
const SLOWEST_FALL: f64 = 0.6;

/// Fronts at most until one leaves the room that settling wants.
const MOST_FRONTS: usize = 4;
/// By this factor a front runs at less smaller radii where the spheres of the one before have
/// jammed, and how often that is done before some are taken out.
const AFTER_JAM: f64 = 0.93;
const MOST_JAMS: usize = 3;

/// The attempts made, and those that may still be made.
pub(super) struct Retry {
    /// The volume to reach, if the shrink is chosen here.
    target: Option<FillTarget>,
    /// Fronts run.
    pub(super) fronts: usize,
    /// Number of times that the spheres have jammed.
    jams: usize,
    /// The bare front is the last that is tried.
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
            fronts: 0,
            jams: 0,
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

    /// The attempt to make in place of one whose front is not good enough.
    pub(super) fn after_front(&mut self, attempt: &Attempt, grown: &Grown) -> Option<Attempt> {
        self.fronts += 1;
        if attempt.fills_voids {
            return self.with_truer_sizes(attempt, grown);
        }
        if self.jams > 0 || self.fronts >= MOST_FRONTS {
            return None;
        }
        let shrink = self.target?.better_shrink(attempt.shrink, grown.volume())?;
        Some(Attempt {
            shrink: rounded(shrink),
            ..attempt.clone()
        })
    }

    /// True if the next settling is the first one.
    pub(super) fn has_not_jammed(&self) -> bool {
        self.jams == 0
    }

    /// Treatment of spheres that jam.
    pub(super) fn when_jammed(&self) -> WhenJammed {
        if self.target.is_some() && self.jams < MOST_JAMS {
            WhenJammed::Stop
        } else {
            WhenJammed::TakeOut
        }
    }

    /// The attempt to make in place of one whose spheres jammed.
    pub(super) fn after_settling(
        &mut self,
        attempt: &Attempt,
        settled: &Settled,
    ) -> Option<Attempt> {
        if !settled.is_stopped {
            return None;
        }
        self.jams += 1;
        Some(Attempt {
            shrink: rounded(AFTER_JAM * attempt.shrink),
            ..attempt.clone()
        })
    }

    /// A bare front that keeps back the sizes that were too many in this one, unless they are true.
    fn with_truer_sizes(&mut self, attempt: &Attempt, grown: &Grown) -> Option<Attempt> {
        let quota = grown.quota()?;
        let placed = grown.spheres() as f64;
        let imbalance = quota.imbalance() / placed.sqrt();
        let most_imbalance = MOST_IMBALANCE[usize::from(self.fronts > STRICT_ATTEMPTS)];
        if self.is_last || (imbalance < most_imbalance && !grown.has_left_voids()) {
            return None;
        }
        // Where too few small spheres can be kept back for all voids, more attempts would not
        // change that.
        let is_hopeless = self.fronts == 1 && grown.has_left_voids()
            || imbalance > HOPELESS_IMBALANCE.max(SLOWEST_FALL * self.last_imbalance);
        self.is_last = is_hopeless || self.fronts + 1 == MOST_BARE_FRONTS;
        self.last_imbalance = imbalance;
        Some(Attempt {
            expected: Some(placed),
            most_too_many: MOST_TOO_MANY[usize::from(self.is_last)],
            // Nothing is kept back where voids are left anyway.
            quota: (!self.is_last).then(|| quota.corrected()),
            ..attempt.clone()
        })
    }
}
