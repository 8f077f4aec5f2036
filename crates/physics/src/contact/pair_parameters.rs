//! Damping and friction of a pair of materials: common to all normal laws.

use super::restitution::{damping_ratio, damping_ratio_with_attraction};
use serde::Serialize;

/// Elastic properties of a material in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Young's modulus, Pa: infinite for a rigid end.
    pub young_modulus_pa: f64,
    /// Poisson's ratio.
    pub poisson_ratio: f64,
}

/// Treatment of the normal force when damping would make it attractive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AttractiveDamping {
    /// Cut off at 0.
    None,
    /// Attractive until the overlap is 0, as in Tsuji et al. 1992: for comparison with programs
    /// that do so.
    AsDamped,
}

/// Quantity that the tangential spring keeps while the normal load changes its stiffness.
///
/// Mindlin and Deresiewicz 1953 is a full theory of partial slip; these are the simple laws that
/// programs use instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TangentialUnloading {
    /// The force while the load rises and the displacement while the load falls (Thornton et al.
    /// 2013): no cycle of load and displacement creates energy.
    LesserForce,
    /// The force: for comparison. A cycle may create energy.
    Force,
    /// The displacement: for comparison. A cycle may create energy.
    Elongation,
}

/// Measured behaviour of a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairInput {
    /// Coefficient of restitution of a central impact, above 0, at most 1.
    pub restitution: f64,
    /// Coefficient of friction.
    pub friction: f64,
    /// Tangential damping relative to that of Tsuji et al. 1992, who use the ratio of the normal
    /// direction: 1 as there, 0 for none.
    pub tangential_damping: f64,
    /// Whether damping may be attractive.
    pub pull: AttractiveDamping,
    /// Quantity that the tangential spring keeps.
    pub kept: TangentialUnloading,
}

impl PairInput {
    /// A pair with this restitution and friction and the recommended values of all other
    /// parameters.
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

/// Damping and friction of a pair, in the form that the laws need.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PairParameters<T = f64> {
    /// Damping ratio along the normal.
    pub damping_ratio: T,
    /// Damping ratio across it.
    pub tangential_damping_ratio: T,
    /// Coefficient of friction.
    pub friction: T,
    /// Least normal force, N.
    pub least_n: T,
    /// Smallest and largest fraction of its displacement that the tangential spring keeps in a
    /// step.
    pub kept: [T; 2],
}

impl PairParameters {
    /// The parameters of several contacts at once, one for each lane.
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

    /// From the measured behaviour of a pair.
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
