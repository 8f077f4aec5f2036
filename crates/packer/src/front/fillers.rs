//! Voids filled while the bare front advances, without distorting the sizes. Not used before
//! settling, which moves the spheres anyway.
//!
//! A front sphere may be about to leave the queue although a smaller sphere than the one drawn fits
//! around it. Then about the largest sphere that fits is placed, and its size is drawn less often
//! afterwards. So no void is left that takes the smallest sphere, and the sizes placed still follow
//! the distribution.

use super::assembly::{Assembly, FrontSphere};
use super::draws::Draws;
use super::places::{Place, Workspace};
use super::quota::{SizeQuota, class_of};
use crate::spheres::{ReducedSphere, Vector3, distance};
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use std::collections::BTreeMap;
use std::ops::Range;

/// Range of the ratio of the next smaller quantile tried for a void to the last one: one half on
/// average, but never the same. Repeated halving would fill all voids with a few sizes, and need
/// more of those than can be held back, as in a ball, where the front reaches the entire wall last.
const SMALLER: Range<f64> = 1.0 / 3.0..2.0 / 3.0;
/// Largest number of quantiles tried: the last is about one five-hundredth of the first.
const FILLERS_TRIED: usize = 9;
/// Voids are filled at once as long as the surplus of small spheres, in square roots of the number
/// of spheres, is below this (a fifth of the effect of chance). Others wait until the front is
/// `LAG` shells farther: draws made meanwhile may have filled them.
const MOST_AT_ONCE: f64 = 0.27;
const LAG: u32 = 3;
/// Approximate number of voids filled in a block: one of eight among about 70 spheres fills a void.
const FILLERS_OF_BLOCK: f64 = 10.0;

/// Limits to the filling of voids.
#[derive(Debug, Clone)]
pub(crate) struct FillingSettings {
    /// Expected number of spheres, approximately.
    pub(crate) expected: f64,
    /// Surplus of small spheres, in square roots of the number of spheres, below which voids are
    /// filled at all.
    pub(crate) most_too_many: f64,
    /// The quota to begin with, if it is to balance the sizes of an earlier attempt.
    pub(crate) quota: Option<SizeQuota>,
}

/// The voids of a front: those filled, and those waiting or left.
pub(super) struct Fillers {
    settings: FillingSettings,
    /// Sizes placed, drawn or chosen.
    pub(super) quota: SizeQuota,
    /// For each cell, true if spheres there may have neighbours that touch the wall.
    pub(super) wall_in_reach: Vec<bool>,
    /// Spheres that left the queue with room around them for the smallest sphere, by shell.
    with_room: BTreeMap<u32, Vec<FrontSphere>>,
    /// Spheres among them around which voids had to be left.
    pub(super) left_open: Vec<FrontSphere>,
    /// Number of spheres chosen to fill voids.
    pub(super) placed: usize,
    /// Number of fillers that touch fewer than three other spheres or walls.
    pub(super) loose: usize,
}

impl Fillers {
    pub(super) fn new(mut settings: FillingSettings, assembly: &Assembly) -> Self {
        let quota = settings.quota.take();
        Self {
            quota: quota.unwrap_or_else(|| SizeQuota::new(settings.expected)),
            settings,
            wall_in_reach: assembly.cells_with_wall_in_reach(),
            with_room: BTreeMap::new(),
            left_open: Vec::new(),
            placed: 0,
            loose: 0,
        }
    }

    /// Rules for blocks that draw sizes (`draws`) or else only fill voids, and that begin with this
    /// number of front spheres.
    pub(super) fn rules(&self, draws: bool, front_spheres: usize) -> FillingRules<'_> {
        let most_too_many = if draws {
            MOST_AT_ONCE
        } else {
            self.settings.most_too_many
        };
        FillingRules {
            draws,
            left_out: self.quota.fractions_left_out(front_spheres),
            fills: self.allowed(most_too_many) > 0.0,
            wall_in_reach: &self.wall_in_reach,
        }
    }

    /// Number of voids that may still be filled for a surplus of small spheres of this many square
    /// roots of the number of spheres.
    fn allowed(&self, most_too_many: f64) -> f64 {
        most_too_many * self.settings.expected.sqrt() - self.quota.too_many()
    }

    /// Number of blocks that may work until the quota is checked again: no more than can fill the
    /// allowed number of voids.
    pub(super) fn blocks_at_once(&self) -> usize {
        let allowed = self.allowed(self.settings.most_too_many);
        if allowed > 0.0 {
            (allowed / FILLERS_OF_BLOCK).ceil() as usize
        } else {
            usize::MAX
        }
    }

    /// The spheres of the next shell, at least `LAG` shells behind `shell`, that left the queue
    /// with room around them.
    pub(super) fn next_behind(&mut self, shell: u32) -> Option<Vec<FrontSphere>> {
        let entry = self.with_room.first_entry()?;
        (*entry.key() <= shell.saturating_sub(LAG)).then(|| entry.remove())
    }

    /// Adds the result of a block. `shell_of` a sphere of the front is only called where sizes were
    /// drawn.
    pub(super) fn merge(
        &mut self,
        filled: FilledVoids,
        draws: bool,
        shell_of: impl Fn(&FrontSphere) -> u32,
    ) {
        for sphere in filled.with_room {
            if draws {
                let shell = shell_of(&sphere);
                self.with_room.entry(shell).or_default().push(sphere);
            } else {
                self.left_open.push(sphere);
            }
        }
        filled.quantiles.iter().for_each(|u| self.quota.place(*u));
        self.placed += filled.placed;
        self.loose += filled.loose;
    }
}

/// Rules for all blocks that work at the same time.
pub(super) struct FillingRules<'a> {
    /// True if sizes are drawn, and not only voids filled.
    draws: bool,
    /// Probability for each class of the quota that a draw is left out.
    left_out: Vec<f64>,
    /// True if voids may be filled.
    fills: bool,
    wall_in_reach: &'a [bool],
}

impl FillingRules<'_> {
    /// A draw from a class of sizes without a surplus.
    fn draw(&self, random: &mut ChaCha8Rng) -> f64 {
        loop {
            let quantile = random.random::<f64>();
            let left_out = self.left_out[class_of(quantile, self.left_out.len())];
            if left_out == 0.0 || random.random::<f64>() >= left_out {
                return quantile;
            }
        }
    }
}

/// The voids of a block, filled and left.
#[derive(Default)]
pub(super) struct FilledVoids {
    /// Quantiles of all spheres placed.
    quantiles: Vec<f64>,
    /// Number of spheres chosen to fill voids.
    placed: usize,
    /// Number of fillers that touch fewer than three other spheres or walls.
    loose: usize,
    /// Front spheres that left the queue with room around them for the smallest sphere.
    with_room: Vec<FrontSphere>,
}

/// The voids of a block at work.
pub(super) struct BlockFillers<'a> {
    rules: &'a FillingRules<'a>,
    /// Spheres of this quantile and above no longer fit around the front sphere.
    too_large: f64,
    /// A place for the smallest sphere next to the front sphere.
    void: Option<Vector3>,
    filled: FilledVoids,
}

impl<'a> BlockFillers<'a> {
    pub(super) fn new(rules: &'a FillingRules<'a>) -> Self {
        Self {
            rules,
            too_large: f64::INFINITY,
            void: None,
            filled: FilledVoids::default(),
        }
    }

    /// A place next to the front sphere `initial` for the size drawn, or for one that fits if that
    /// does not. `assembled` are the spheres not yet in the grid.
    pub(super) fn candidate(
        &mut self,
        assembly: &Assembly,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        seed: &Vector3,
        assembled: &[ReducedSphere],
        draws: &mut Draws,
    ) -> Option<Place> {
        if self.void.is_none() {
            let wall_in_reach = self.rules.wall_in_reach;
            self.void = assembly.place_for_smallest(workspace, initial, wall_in_reach, |_| true);
        }
        let void = self.void?;
        if self.rules.draws {
            let quantile = draws.current(|random| self.rules.draw(random));
            if quantile < self.too_large {
                let radius = assembly.radius(quantile);
                if let Some(centre) = assembly.best_place(workspace, initial, radius, seed) {
                    draws.placed();
                    return Some(Place { centre, quantile });
                }
                self.too_large = quantile;
            }
        }
        if !self.rules.fills {
            return None;
        }
        self.filled.placed += 1;
        let random = &mut draws.random;
        let filler = self.smaller(assembly, workspace, initial, seed, random);
        filler.or_else(|| {
            self.filled.loose += 1;
            Some(assembly.roomiest_place(&void, assembled))
        })
    }

    /// A sphere for a void next to the front sphere `initial`: the first that fits as the quantiles
    /// decrease, if one of those tried does.
    fn smaller(
        &mut self,
        assembly: &Assembly,
        workspace: &mut Workspace,
        initial: &ReducedSphere,
        seed: &Vector3,
        random: &mut ChaCha8Rng,
    ) -> Option<Place> {
        for _ in 0..FILLERS_TRIED {
            let quantile = random.random_range(SMALLER) * self.too_large.min(1.0);
            let radius = assembly.radius(quantile);
            match assembly.best_place(workspace, initial, radius, seed) {
                Some(centre) => return Some(Place { centre, quantile }),
                None => self.too_large = quantile,
            }
        }
        None
    }

    /// Records a sphere that was placed, drawn or chosen.
    pub(super) fn placed(&mut self, assembly: &Assembly, sphere: &ReducedSphere, quantile: f64) {
        let reach = sphere[3] + assembly.reduced(assembly.settings.radius_range[0]);
        self.void = self.void.filter(|place| distance(sphere, place) >= reach);
        self.filled.quantiles.push(quantile);
    }

    /// Ends the work around a front sphere.
    pub(super) fn retire(&mut self, initial: FrontSphere) {
        if self.void.take().is_some() {
            self.filled.with_room.push(initial);
        }
        self.too_large = f64::INFINITY;
    }

    pub(super) fn filled(self) -> FilledVoids {
        self.filled
    }
}
