//! The bond models, and the reference values.

use dem_run::physics::bond::stiffness::BondModel;
use serde_json::Value;

/// A bond model.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Named {
    /// Name on the page.
    pub(crate) name: &'static str,
    /// Name in the reference values.
    pub(crate) key: &'static str,
    /// The model.
    pub(crate) model: BondModel,
}

/// Parallel.
pub(crate) const PARALLEL: BondModel = BondModel::Parallel { kappa: None };

/// The paper's three models, and the other two.
pub(crate) const MODELS: [Named; 5] = [
    Named {
        name: "parallel (PBM)",
        key: "PBM",
        model: PARALLEL,
    },
    Named {
        name: "Euler-Bernoulli (EBBM)",
        key: "EBBM",
        model: BondModel::EulerBernoulli,
    },
    Named {
        name: "Timoshenko (TBBM)",
        key: "TBBM",
        model: BondModel::Timoshenko,
    },
    Named {
        name: "elastic solid",
        key: "MUSEN",
        model: BondModel::ElasticSolid,
    },
    Named {
        name: "shear coefficient",
        key: "OBERMAYR",
        model: BondModel::ShearCoefficient { alpha: 0.9 },
    },
];

/// Exact solutions of the bars under a small load by direct stiffness, by an independent
/// implementation.
pub(crate) fn small_load() -> Value {
    serde_json::from_str(include_str!("data/cantilever.json")).unwrap()
}

/// Solutions of an independent implementation for the bar of case 1 under the paper's load.
pub(crate) fn whole_load() -> Value {
    serde_json::from_str(include_str!("data/static_case1.json")).unwrap()
}

/// A number in the reference values.
pub(crate) fn number(values: &Value, path: &str) -> f64 {
    values.pointer(path).and_then(Value::as_f64).unwrap()
}

/// The numbers of a list in the reference values.
pub(crate) fn numbers(values: &Value, path: &str) -> Vec<f64> {
    let list = values.pointer(path).and_then(Value::as_array).unwrap();
    list.iter().map(|value| value.as_f64().unwrap()).collect()
}
