//! Predictions for a scene of the suite, made before its run, and the values that its run gives.

use serde::Serialize;

use super::trial::Trial;
use dem_results::Summary;

/// A scene of a case and its prediction.
#[derive(Debug, Clone)]
pub struct Member {
    /// Its difference from the others of its case.
    pub what: String,
    /// The scene.
    pub trial: Trial,
    /// The method of observation.
    pub way: ObservationMethod,
    /// The prediction.
    pub prediction: Prediction,
}

impl Member {
    /// A run that ends and shows these values.
    pub(crate) fn ends(what: impl Into<String>, trial: Trial, shown: Vec<Shown>) -> Self {
        Self {
            what: what.into(),
            trial,
            way: ObservationMethod::Run,
            prediction: Prediction::Ends(shown),
        }
    }
}

/// How a scene is observed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObservationMethod {
    /// It is run, once.
    Run,
    /// It is stepped with larger and smaller steps; see [`limit_map`](super::limit_map).
    LargestStep,
}

/// Predicted outcome of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Prediction {
    /// The run ends and gives these values.
    Ends(Vec<Shown>),
    /// It is refused before it starts (exit code 2), with these words in the message.
    Refused(Vec<String>),
    /// It is stopped (exit code 3), with these words in the message.
    Stopped(Vec<String>),
}

/// A predicted value of a run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shown {
    /// The quantity.
    pub quantity: Quantity,
    /// SI unit; empty for plain numbers.
    pub unit: &'static str,
    /// Predicted value, in that unit.
    pub value: f64,
    /// Largest deviation, in that unit.
    pub tolerance: f64,
}

/// Quantity of a value.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// A measure of the scene, by its name.
    Measure(&'static str),
    /// Largest relative error of the energy.
    EnergyError,
    /// Largest relative error of the momentum.
    MomentumError,
    /// Largest relative error of the angular momentum.
    AngularMomentumError,
    /// Bonds that broke.
    BrokenBonds,
    /// Energy that damaged bonds have lost.
    BondDamage,
    /// Energy of bodies that came, less that of those that went, and what swaps of their forms
    /// added.
    FlowEnergy,
    /// Clumps that bonded clusters replaced.
    Replaced,
    /// Clusters that became clumps again.
    Restored,
    /// Fragments at the end.
    Fragments,
    /// Spheres that were released from rigid parts.
    Released,
    /// Spheres that joined rigid parts again.
    Rejoined,
    /// Largest stable time step.
    LargestStep,
}

impl Shown {
    /// A measure of the scene, in this SI unit.
    pub fn measure(name: &'static str, unit: &'static str, value: f64, tolerance: f64) -> Self {
        Self {
            quantity: Quantity::Measure(name),
            unit,
            value,
            tolerance,
        }
    }

    /// A plain number that should be 0 and may be at most this.
    pub fn at_most(quantity: Quantity, limit: f64) -> Self {
        Self {
            quantity,
            unit: "",
            value: 0.0,
            tolerance: limit,
        }
    }

    /// A value between these two.
    pub fn between(quantity: Quantity, unit: &'static str, least: f64, largest: f64) -> Self {
        Self {
            quantity,
            unit,
            value: 0.5 * (least + largest),
            tolerance: 0.5 * (largest - least),
        }
    }

    /// A count, which must be exact.
    pub fn count(quantity: Quantity, count: usize) -> Self {
        Self {
            value: count as f64,
            ..Self::at_most(quantity, 0.0)
        }
    }

    /// Deviation of a value, in tolerances; infinite for NaN.
    pub fn deviation(&self, observed: f64) -> f64 {
        let off = (observed - self.value).abs();
        match off {
            _ if off.is_nan() => f64::INFINITY,
            _ if off <= self.tolerance && self.tolerance == 0.0 => 0.0,
            _ => off / self.tolerance,
        }
    }
}

impl Quantity {
    /// Human-readable name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Measure(name) => name,
            Self::EnergyError => "energy error",
            Self::MomentumError => "momentum error",
            Self::AngularMomentumError => "angular momentum error",
            Self::BrokenBonds => "broken bonds",
            Self::BondDamage => "bond damage",
            Self::FlowEnergy => "flow energy",
            Self::Replaced => "replaced clumps",
            Self::Restored => "restored clumps",
            Self::Fragments => "fragments",
            Self::Released => "released spheres",
            Self::Rejoined => "rejoined spheres",
            Self::LargestStep => "largest stable step",
        }
    }

    /// Its value in a run; NaN if there is none.
    pub fn of(&self, summary: &Summary) -> f64 {
        match self {
            Self::Measure(name) => {
                let found = summary.measures.iter().find(|m| m.name == *name);
                found.map_or(f64::NAN, |measured| measured.value)
            }
            Self::EnergyError => summary.energy_error,
            Self::MomentumError => summary.momentum_error,
            Self::AngularMomentumError => summary.angular_momentum_error,
            Self::BrokenBonds => summary.broken_bonds as f64,
            Self::BondDamage => summary.balance.bond_damage_j,
            Self::Fragments => {
                let fragments = summary.fragments.as_ref();
                fragments.map_or(f64::NAN, |fragments| fragments.count as f64)
            }
            Self::FlowEnergy => summary.balance.flow_energy_j,
            Self::Replaced | Self::Restored | Self::Released | Self::Rejoined => {
                let counted = summary.population.as_ref().map(|population| match self {
                    Self::Replaced => u64::from(population.replaced),
                    Self::Restored => u64::from(population.restored),
                    Self::Released => population.released,
                    _ => population.rejoined,
                });
                counted.map_or(f64::NAN, |count| count as f64)
            }
            Self::LargestStep => f64::NAN,
        }
    }
}
