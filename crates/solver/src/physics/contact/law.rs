//! The contact laws and rolling friction models available to a pair of materials: the one place
//! that lists them. See `doc/adding-a-model.md` for how to add another.

use super::dmt::DerjaguinMullerToporov;
use super::hertz_mindlin::HertzMindlin;
use super::kinematics::ContactKinematics;
use super::linear::Linear;
use super::normal::{ImpactLaw, NormalLaw};
use super::rolling::{ConstantMoment, ElasticPlastic, NoRolling, RollingFriction};
use super::{Linearised, linearised};
use crate::physics::number::Number;
use serde::Serialize;

/// Normal law of a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum Law {
    /// Hertz and Mindlin.
    HertzMindlin(HertzMindlin),
    /// Hertz and Mindlin with adhesion.
    DerjaguinMullerToporov(DerjaguinMullerToporov),
    /// Springs and dashpots.
    Linear(Linear),
}

/// Rolling friction of a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub enum Rolling {
    /// None.
    Free,
    /// Constant moment.
    Constant(ConstantMoment),
    /// Spring and dashpot.
    Spring(ElasticPlastic),
}

/// Contact type of a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactKind {
    /// Normal and tangential law.
    pub law: Law,
    /// Rolling friction.
    pub rolling: Rolling,
}

impl Law {
    /// The law, for the choice of the time step.
    pub fn at_impact(&self) -> &dyn ImpactLaw {
        match self {
            Self::HertzMindlin(law) => law,
            Self::DerjaguinMullerToporov(law) => law,
            Self::Linear(law) => law,
        }
    }
}

/// Work that is generic over the law and the rolling friction.
pub trait ContactWork<T: Number> {
    /// Its result.
    type Output;

    /// Does the work.
    fn with(self, law: &impl NormalLaw<T>, rolling: &impl RollingFriction<T>) -> Self::Output;
}

impl ContactKind {
    /// Does work with the law and the rolling friction of this type. `all` converts plain numbers
    /// to those of the formulas: one for each of several contacts at once, or the number itself.
    #[inline(always)]
    pub fn with<T: Number, W: ContactWork<T>>(
        &self,
        all: impl Fn(f64) -> T + Copy,
        work: W,
    ) -> W::Output {
        match &self.law {
            Law::HertzMindlin(law) => self.with_law(&law.in_lanes(all), all, work),
            Law::DerjaguinMullerToporov(law) => self.with_law(&law.in_lanes(all), all, work),
            Law::Linear(law) => self.with_law(&law.in_lanes(all), all, work),
        }
    }

    #[inline(always)]
    fn with_law<T: Number, W: ContactWork<T>>(
        &self,
        law: &impl NormalLaw<T>,
        all: impl Fn(f64) -> T,
        work: W,
    ) -> W::Output {
        match &self.rolling {
            Rolling::Free => work.with(law, &NoRolling),
            Rolling::Constant(rolling) => work.with(law, &rolling.in_lanes(all)),
            Rolling::Spring(rolling) => work.with(law, &rolling.in_lanes(all)),
        }
    }

    /// Normal stiffness at an overlap, m, with an effective radius, m, in N/m; 0 without overlap.
    pub fn normal_n_m(&self, overlap_m: f64, effective_radius_m: f64) -> f64 {
        let law = self.law.at_impact();
        law.normal_n_m(overlap_m.max(0.0), effective_radius_m)
    }

    /// Force without damping, N, its derivative with respect to the overlap, N/m, and energy, J, of
    /// a contact at rest.
    pub(crate) fn elastic(&self, touch: &ContactKinematics) -> [f64; 3] {
        struct Elastic<'a>(&'a ContactKinematics);
        impl ContactWork<f64> for Elastic<'_> {
            type Output = [f64; 3];

            fn with(self, law: &impl NormalLaw<f64>, _: &impl RollingFriction<f64>) -> [f64; 3] {
                let normal = law.evaluate(self.0, self.0.overlap_m, 0.0);
                [normal.elastic_n, normal.normal_n_m[1], normal.energy_j]
            }
        }
        self.with(|number| number, Elastic(touch))
    }

    /// The contact linearised: see [`linearised`].
    pub fn linearised(&self, touch: &ContactKinematics) -> Linearised {
        struct Linearise<'a>(&'a ContactKinematics);
        impl ContactWork<f64> for Linearise<'_> {
            type Output = Linearised;

            fn with(
                self,
                law: &impl NormalLaw<f64>,
                rolling: &impl RollingFriction<f64>,
            ) -> Linearised {
                linearised(law, rolling, self.0)
            }
        }
        self.with(|number| number, Linearise(touch))
    }
}
