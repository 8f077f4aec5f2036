//! What the bonds of a kind share: the law of their loads, damping, strengths.

use dem_physics::bond::failure::Criteria;
use dem_physics::bond::flat_joint::FlatJointLaw;
use dem_physics::bond::plasticity::Plasticity;
use dem_physics::bond::rate_strengthening::RateStrengthening;
use dem_scene::StrainRateMeasure;
use serde::Serialize;

/// How the load of a bond follows from its deformation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum BondLaw {
    /// From the present positions; the bond breaks at its strength.
    Elastic,
    /// Summed step by step.
    Incremental,
    /// Elastic up to yield strengths, with hardening beyond them.
    ElastoPlastic(Plasticity),
    /// Elastic up to the strength, beyond which the bond softens.
    Softening {
        /// Energy per area that it takes to pull a bond apart, J/m2.
        fracture_energy_j_m2: f64,
    },
    /// A section of elements, each of which fails by itself.
    FlatJoint(FlatJointLaw),
}

/// What the forces of a bond follow from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// The present positions, by the total formulation.
    Positions,
    /// Loads that are summed step by step.
    Sums,
    /// The elements of its section.
    Elements,
}

impl BondLaw {
    /// Yield strengths and hardening. None: the law has none.
    pub fn plasticity(&self) -> Option<Plasticity> {
        match self {
            Self::ElastoPlastic(plasticity) => Some(*plasticity),
            _ => None,
        }
    }

    /// Energy per area that it takes to pull a bond apart, J/m2. None: bonds do not soften.
    pub fn fracture_energy_j_m2(&self) -> Option<f64> {
        match self {
            Self::Softening {
                fracture_energy_j_m2,
            } => Some(*fracture_energy_j_m2),
            _ => None,
        }
    }

    /// Elements of a flat joint. None: bonds have none.
    pub fn flat_joint(&self) -> Option<FlatJointLaw> {
        match self {
            Self::FlatJoint(law) => Some(*law),
            _ => None,
        }
    }

    /// What the forces of a bond follow from.
    pub(super) fn source(&self) -> Source {
        match self {
            Self::Elastic | Self::ElastoPlastic(_) | Self::Softening { .. } => Source::Positions,
            Self::Incremental => Source::Sums,
            Self::FlatJoint(_) => Source::Elements,
        }
    }

    /// The key of a kind of bonds that asks for this law. None: no key does.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Elastic => None,
            Self::Incremental => Some("formulation"),
            Self::ElastoPlastic(_) => Some("plasticity"),
            Self::Softening { .. } => Some("failure.fracture_energy"),
            Self::FlatJoint(_) => Some("model"),
        }
    }

    /// Whether bonds are computed one at a time, by a stage of their own.
    pub fn is_single(&self) -> bool {
        match self {
            Self::Elastic | Self::Softening { .. } => false,
            Self::Incremental | Self::ElastoPlastic(_) | Self::FlatJoint(_) => true,
        }
    }
}

/// Properties that the bonds of a rule share.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BondRule {
    /// How loads follow from deformation.
    pub law: BondLaw,
    /// Bonds have damping coefficients.
    pub damped: bool,
    /// Fraction of the load of a bond that resists its relative motion: gamma. 0: none.
    pub structural_damping: f64,
    /// Strengths. None: the bonds never break.
    pub criteria: Option<Criteria>,
    /// How strengths rise with the strain rate. None: they do not.
    pub strengthening: Option<RateStrengthening>,
    /// The strain whose rate is used.
    pub strain_rate_measure: StrainRateMeasure,
    /// The contact law of the two ends acts beside the bond.
    pub contact_beside: bool,
}

impl BondRule {
    /// Whether a bond keeps the largest factor of its strain rates.
    pub fn keeps_largest_factor(&self) -> bool {
        self.strengthening.as_ref().is_some_and(|s| s.keeps_largest)
    }

    /// Whether bonds resist relative motion, by coefficients or by structural damping.
    pub(crate) fn is_damped(&self) -> bool {
        self.damped || self.structural_damping > 0.0
    }
}
