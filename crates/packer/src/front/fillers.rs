//! Voids filled as the bare front goes, with the sizes kept true. Not before settling, which moves
//! the spheres anyway.
//!
//! Where a front sphere would leave the queue although a smaller sphere than the one drawn fits
//! around it, about the largest that fits is placed, and its size is drawn less often afterwards:
//! so no void is left that takes the smallest sphere, and the sizes placed still follow the
//! distribution.

use super::assembly::{Assembly, FrontSphere};
use super::draws::Draws;
use super::places::{Place, Workspace};
use super::quota::{SizeQuota, class_of};
use crate::spheres::{ReducedSphere, Vector3, distance};
use rand::RngExt;
use rand::rngs::ChaCha8Rng;
use std::collections::BTreeMap;
use std::ops::Range;

/// For a void the next smaller quantile is this part of the last: half of it on average, but never
/// the same part. Halves of halves would fill all voids with a few sizes only, and so many more of
/// those than can be kept back: in a ball, where the front comes to the whole wall last.
const SMALLER: Range<f64> = 1.0 / 3.0..2.0 / 3.0;
/// Quantiles tried at most: the last is some five hundredth of the first.
const FILLERS_TRIED: usize = 9;
/// As long as small spheres are not more than expected by this many roots of the number of spheres
/// (a fifth of what chance does), voids are filled at once. Others wait until the front is `LAG`
/// shells farther: draws that were made meanwhile may have filled them.
const MOST_AT_ONCE: f64 = 0.27;
const LAG: u32 = 3;
/// Voids filled in a block, about: of some 70 spheres one in eight fills a void.
const FILLERS_OF_BLOCK: f64 = 10.0;

/// Limits to the filling of voids.
#[derive(Debug, Clone)]
pub(crate) struct FillingSettings {
    /// Spheres expected, about.
    pub(crate) expected: f64,
    /// As long as small spheres are not more than expected by this many roots of the number of
    /// spheres, voids are filled at all.
    pub(crate) most_too_many: f64,
    /// The sizes to begin with, where those of an earlier attempt are to be evened out.
    pub(crate) quota: Option<SizeQuota>,
}

/// The voids of a front: those that were filled, and those that wait or were left.
pub(super) struct Fillers {
    settings: FillingSettings,
    /// Sizes placed, drawn or chosen.
    pub(super) quota: SizeQuota,
    /// Cells in which a sphere may have neighbours that touch the wall.
    pub(super) wall_in_reach: Vec<bool>,
    /// Spheres that left the queue with room around them for the smallest sphere, by shell.
    with_room: BTreeMap<u32, Vec<FrontSphere>>,
    /// Those of them around which voids had to be left.
    pub(super) left_open: Vec<FrontSphere>,
    /// Spheres that were chosen to fill voids.
    pub(super) placed: usize,
    /// Those of them that touch no three others or walls.
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

    /// Rules for blocks that draw sizes (`draws`), or else only fill voids, and begin with so many
    /// front spheres.
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

    /// Number of voids that may still be filled if there may be so many roots of the number of
    /// spheres too many small ones.
    fn allowed(&self, most_too_many: f64) -> f64 {
        most_too_many * self.settings.expected.sqrt() - self.quota.too_many()
    }

    /// Number of blocks that may work until the next look at the quota: no more than fill the voids
    /// that may be filled at all.
    pub(super) fn blocks_at_once(&self) -> usize {
        let allowed = self.allowed(self.settings.most_too_many);
        if allowed > 0.0 {
            (allowed / FILLERS_OF_BLOCK).ceil() as usize
        } else {
            usize::MAX
        }
    }

    /// The spheres of the next shell, `LAG` shells and more behind `shell`, that left the queue
    /// with room around them.
    pub(super) fn next_behind(&mut self, shell: u32) -> Option<Vec<FrontSphere>> {
        let entry = self.with_room.first_entry()?;
        (*entry.key() <= shell.saturating_sub(LAG)).then(|| entry.remove())
    }

    /// Adds what a block did; `shell_of` a sphere of the front is asked where sizes were drawn.
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
    /// Sizes are drawn, and not only voids filled.
    draws: bool,
    /// For each class of the quota the probability with which a draw is left out.
    left_out: Vec<f64>,
    /// Voids may be filled.
    fills: bool,
    wall_in_reach: &'a [bool],
}

impl FillingRules<'_> {
    /// A draw that no class of sizes has had too many of.
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
    /// Number of them chosen to fill voids.
    placed: usize,
    /// Those of them that touch no three others or walls.
    loose: usize,
    /// Front spheres that left the queue with room around them for the smallest sphere.
    with_room: Vec<FrontSphere>,
}

/// The voids of a block at work.
pub(super) struct BlockFillers<'a> {
    rules: &'a FillingRules<'a>,
    /// Spheres of this quantile and above do not fit around the front sphere any more.
    too_large: f64,
    /// A place for the smallest sphere beside the front sphere.
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

    /// A place beside the front sphere `initial` for the size drawn, or for one that fits if that
    /// does not. `assembled` are the spheres that the grid does not hold yet.
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
            self.void = assembly.place_for_smallest(workspace, initial, wall_in_reach);
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

    /// A sphere for a void beside the front sphere `initial`: the first that fits as quantiles
    /// become smaller, if one of some does.
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

    /// A sphere was placed, drawn or chosen.
    pub(super) fn placed(&mut self, assembly: &Assembly, sphere: &ReducedSphere, quantile: f64) {
        let reach = sphere[3] + assembly.reduced(assembly.settings.radius_range[0]);
        self.void = self.void.filter(|place| distance(sphere, place) >= reach);
        self.filled.quantiles.push(quantile);
    }

    /// The work around a front sphere is at an end.
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
