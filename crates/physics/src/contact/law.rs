//! The contact laws and rolling friction models available to a pair of materials: the one place
//! that lists them. See `doc/inside/adding-a-model.md` for how to add another.

pub mod dmt;
pub mod hertz_mindlin;
pub mod linear;

use self::dmt::DerjaguinMullerToporov;
use self::hertz_mindlin::HertzMindlin;
use self::linear::Linear;
use super::kinematics::ContactKinematics;
use super::liquid_bridge::LiquidBridge;
use super::normal::{ImpactLaw, NormalLaw};
use super::rolling::{ConstantMoment, ElasticPlastic, NoRolling, RollingFriction};
use super::{Linearised, linearised};
use crate::number::Number;
use serde::Serialize;

/// Rounds that find the overlap of an impact with a liquid bridge, each of which at least halves
/// the logarithm of what is off.
const ROUNDS: usize = 40;

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
    /// Its liquid bridges, which act beside the law. None: dry.
    pub bridge: Option<LiquidBridge>,
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

    /// Largest overlap of an impact at a speed, m/s, without damping, m. The work of a liquid
    /// bridge, which pulls with its largest force while the ends overlap, adds to the kinetic
    /// energy.
    pub fn overlap_at_impact_m(
        &self,
        effective_radius_m: f64,
        mass_kg: f64,
        speed_m_s: f64,
    ) -> f64 {
        let law = self.law.at_impact();
        let overlap_m =
            |speed_m_s: f64| law.overlap_at_impact_m(effective_radius_m, mass_kg, speed_m_s);
        let Some(bridge) = &self.bridge else {
            return overlap_m(speed_m_s);
        };
        let force_n = bridge.largest_n(effective_radius_m);
        let mut found_m = effective_radius_m.max(overlap_m(speed_m_s));
        for _ in 0..ROUNDS {
            found_m = overlap_m((speed_m_s * speed_m_s + 2.0 * force_n * found_m / mass_kg).sqrt());
        }
        found_m
    }

    /// Force without damping, N, its derivative with respect to the overlap, N/m, and energy, J, of
    /// a contact at rest.
    pub fn elastic(&self, touch: &ContactKinematics) -> [f64; 3] {
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

    /// Energy of the attraction of ends that touch at rest, J: below 0, and part of the energy of
    /// the contact.
    pub fn adhesion_j(&self, touch: &ContactKinematics) -> f64 {
        struct Adhesion<'a>(&'a ContactKinematics);
        impl ContactWork<f64> for Adhesion<'_> {
            type Output = f64;

            fn with(self, law: &impl NormalLaw<f64>, _: &impl RollingFriction<f64>) -> f64 {
                if attracts(law) {
                    law.adhesion_j(self.0)
                } else {
                    0.0
                }
            }
        }
        self.with(|number| number, Adhesion(touch))
    }

    /// Whether ends that touch attract each other.
    pub fn attracts(&self) -> bool {
        struct Attracts;
        impl ContactWork<f64> for Attracts {
            type Output = bool;

            fn with(self, law: &impl NormalLaw<f64>, _: &impl RollingFriction<f64>) -> bool {
                attracts(law)
            }
        }
        self.with(|number| number, Attracts)
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

/// Whether this law attracts.
fn attracts<L: NormalLaw<f64>>(_: &L) -> bool {
    L::ATTRACTS
}
