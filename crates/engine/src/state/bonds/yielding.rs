//! Bonds that yield: their form without load.

use super::{BLOCK, Bonds};
use dem_physics::bond::plasticity::{PlasticDeformation, StressFree};

impl Bonds {
    /// Whether bond `at`, broken or not, has yielded.
    pub fn has_yielded(&self, at: usize) -> bool {
        let plastic = self.histories.plastics.get(at);
        plastic.is_some_and(|plastic| *plastic != PlasticDeformation::NONE)
    }

    /// Number of unbroken bonds that have yielded. None: no bond yields.
    pub fn count_yielded(&self) -> Option<usize> {
        let is_one = |at: &usize| self.has_yielded(*at) && !self.is_broken(*at);
        let count = || (0..self.len()).filter(is_one).count();
        (!self.histories.plastics.is_empty()).then(count)
    }

    /// Bond `at`, whose rule has a plasticity, without load.
    pub(crate) fn stress_free(&self, at: usize) -> StressFree {
        StressFree {
            levers_m: self.levers_m(at),
            direction: self.direction(at),
            plastic: self.histories.plastics[at],
        }
    }

    /// Gives bond `at`, whose rule has a plasticity, this form without load.
    pub(crate) fn set_stress_free(&mut self, at: usize, bond: &StressFree) {
        let (block, i) = (&mut self.blocks[at / BLOCK], at % BLOCK);
        for axis in 0..3 {
            block.direction[axis][i] = bond.direction[axis];
        }
        for end in 0..2 {
            block.levers_m[end][i] = bond.levers_m[end];
        }
        self.histories.plastics[at] = bond.plastic;
    }
}
