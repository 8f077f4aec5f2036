//! Bond laws compared with closed forms, reference values and their own energy.

mod damping;
mod failure;
mod incremental;
mod pair;
mod rate_strengthening;
mod scatter;
mod stiffness;
mod strain_rate;
mod tangent;
mod total;

use dem_physics::bond::stiffness::BondModel;
use nalgebra::Vector3;
use proptest::prelude::*;

/// Every bond model.
pub(crate) const MODELS: [BondModel; 7] = [
    BondModel::Parallel { kappa: None },
    BondModel::Pin { kappa: None },
    BondModel::Rojek { kappa: None },
    BondModel::EulerBernoulli,
    BondModel::Timoshenko,
    BondModel::ElasticSolid,
    BondModel::ShearCoefficient { alpha: 0.9 },
];

/// Vectors in a cube of twice this edge.
pub(crate) fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}
