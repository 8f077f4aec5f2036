//! How a pair of materials damps and rubs: what all normal laws share.

use super::restitution::{damping_ratio, damping_ratio_with_attraction};
use serde::Serialize;

/// A material, as elastic contact sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Young's modulus, Pa: infinite for a rigid end.
    pub young_modulus_pa: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
}

/// What becomes of the normal force when damping would make it pull.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttractiveDamping {
    /// It is cut off at 0.
    None,
    /// It pulls until the overlap is 0, as in Tsuji et al. 1992: for comparison with programs that
    /// do so.
    AsDamped,
}

/// What the tangential spring keeps while the normal load changes its stiffness.
///
/// Mindlin and Deresiewicz 1953 is a whole theory of partial slip; these are the simple laws that
/// programs use instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TangentialUnloading {
    /// Its force while the load rises and its elongation while the load falls (Thornton et al.
    /// 2013): no cycle of load and displacement creates energy.
    LesserForce,
    /// Its force: for comparison. A cycle may create energy.
    Force,
    /// Its elongation: for comparison. A cycle may create energy.
    Elongation,
}

/// How a pair behaves, as it is measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairInput {
    /// Coefficient of restitution of a central impact, above 0, at most 1.
    pub restitution: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Tangential damping over that of Tsuji et al. 1992, who use the ratio of the normal
    /// direction: 1 as there, 0 for none.
    pub tangential_damping: f64,
    /// Whether damping may pull.
    pub pull: AttractiveDamping,
    /// What the tangential spring keeps.
    pub kept: TangentialUnloading,
}

impl PairInput {
    /// A pair of this restitution and friction with everything else as recommended.
    pub fn new(restitution: f64, friction: f64) -> Self {
        Self {
            restitution,
            friction,
            tangential_damping: 1.0,
            pull: AttractiveDamping::None,
            kept: TangentialUnloading::LesserForce,
        }
    }
}

/// How a pair damps and rubs, as the laws need it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairParameters<T = f64> {
    /// Fraction of critical damping along the normal.
    pub damping_ratio: T,
    /// The same across it.
    pub tangential_damping_ratio: T,
    /// Coefficient of friction.
    pub friction: T,
    /// Least normal force, N.
    pub least_n: T,
    /// Least and largest share of its elongation that the tangential spring keeps in a step.
    pub kept: [T; 2],
}

impl PairParameters {
    /// The same for as many contacts at once as a number stands for.
    #[inline(always)]
    pub fn in_lanes<T>(&self, all: impl Fn(f64) -> T) -> PairParameters<T> {
        PairParameters {
            damping_ratio: all(self.damping_ratio),
            tangential_damping_ratio: all(self.tangential_damping_ratio),
            friction: all(self.friction),
            least_n: all(self.least_n),
            kept: self.kept.map(all),
        }
    }

    /// Of a pair that behaves so.
    pub fn new(pair: &PairInput) -> Self {
        let (ratio, least_n) = match pair.pull {
            AttractiveDamping::None => (damping_ratio(pair.restitution), 0.0),
            AttractiveDamping::AsDamped => (
                damping_ratio_with_attraction(pair.restitution),
                f64::NEG_INFINITY,
            ),
        };
        Self {
            damping_ratio: ratio,
            tangential_damping_ratio: pair.tangential_damping * ratio,
            friction: pair.friction,
            least_n,
            kept: match pair.kept {
                TangentialUnloading::LesserForce => [0.0, 1.0],
                TangentialUnloading::Force => [0.0, f64::INFINITY],
                TangentialUnloading::Elongation => [1.0, 1.0],
            },
        }
    }
}
