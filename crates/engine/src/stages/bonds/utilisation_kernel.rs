//! How near bonds are to their strength, at the speed of the loop of bond forces.

use std::ops::Range;

use super::forces::Kind;
use crate::stages::bonds::blocks::{BondGroup, blocks_of, coming_second_ends, fetch_soon_of};
use crate::state::bonds::{BLOCK, Bonds};
use crate::state::particles::Pose;
use dem_physics::lanes::{LaneWork, Lanes, with_most_lanes};

/// Sets `squares` to the squared utilisations of a range of bonds that share a rule, before any
/// scatter or strengthening of strengths, to 1e-13 of their terms: the rule has no history, and no
/// bond is damaged. 0 without strengths.
pub fn squared_utilisations(
    bonds: &Bonds,
    poses: &[Pose],
    rule: usize,
    range: Range<usize>,
    squares: &mut [f64],
) {
    let kind = Kind::of(bonds, rule);
    with_most_lanes(Squares {
        bonds,
        poses,
        kind: &kind,
        range,
        squares,
    });
}

struct Squares<'a> {
    bonds: &'a Bonds,
    poses: &'a [Pose],
    kind: &'a Kind,
    range: Range<usize>,
    squares: &'a mut [f64],
}

impl LaneWork for Squares<'_> {
    #[inline(always)]
    fn with<T: Lanes>(self, proof: T::Proof) {
        let Some(screen) = &self.kind.screen else {
            return self.squares.fill(0.0);
        };
        for block in blocks_of(&self.range) {
            for b in coming_second_ends(self.bonds, block) {
                fetch_soon_of(self.poses, b);
            }
            let eight = BondGroup::of_block(self.bonds, block, &self.range);
            let numbers = &self.bonds.blocks[block];
            for first in (0..BLOCK).step_by(T::COUNT) {
                if !eight.any_wanted::<T>(first) {
                    continue;
                }
                let response = (self.kind).response::<T>(proof, &eight, numbers, first, self.poses);
                let radius_m = T::load(proof, &numbers.radii_m, first);
                let [used, factor] =
                    screen.utilisation_and_factor::<T, true>(&response.load, radius_m);
                let found = (used * factor.inverse()).values();
                for (i, square) in (first..).zip(&found[..T::COUNT]) {
                    if eight.wanted.contains(&i) {
                        self.squares[block * BLOCK + i - self.range.start] = *square;
                    }
                }
            }
        }
    }
}
