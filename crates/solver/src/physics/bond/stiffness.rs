//! The bond models: the one place that lists them. `doc/adding-a-model.md` tells how another one is
//! added.

use super::models::elastic_solid::ElasticSolid;
use super::models::euler_bernoulli::EulerBernoulli;
use super::models::parallel::Parallel;
use super::models::shear_coefficient::ShearCoefficient;
use super::models::timoshenko::Timoshenko;
pub use super::rod::{BondShape, Stiffness};
use super::rod::{Rod, RodModel};

/// Which beam a bond is taken for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondModel {
    /// Parallel bond: shear stiffness is the normal stiffness over `kappa`, 2 (1 + nu) unless
    /// given. Shear acts halfway between the surfaces of the spheres.
    Parallel {
        /// Normal over shear stiffness.
        kappa: Option<f64>,
    },
    /// Slender beam: no shear deformation.
    EulerBernoulli,
    /// Beam with shear deformation, shear form factor 10/9.
    Timoshenko,
    /// MUSEN's bond: each mode as for a rod of the bond's length.
    ElasticSolid,
    /// Beam of Platzer 2022: as the elastic solid bond, with the shear stiffness times a
    /// coefficient.
    ShearCoefficient {
        /// Shear coefficient, 0.9 for a circular section.
        alpha: f64,
    },
}

/// Stiffness of a bond of Young's modulus `young_modulus_pa` and Poisson's ratio `poisson_ratio`.
pub fn stiffness(
    model: BondModel,
    shape: &BondShape,
    young_modulus_pa: f64,
    poisson_ratio: f64,
) -> Stiffness {
    let rod = Rod {
        shape: *shape,
        young_modulus_pa,
        poisson_ratio,
    };
    match model {
        BondModel::Parallel { kappa } => Parallel { kappa }.stiffness(&rod),
        BondModel::EulerBernoulli => EulerBernoulli.stiffness(&rod),
        BondModel::Timoshenko => Timoshenko.stiffness(&rod),
        BondModel::ElasticSolid => ElasticSolid.stiffness(&rod),
        BondModel::ShearCoefficient { alpha } => ShearCoefficient { alpha }.stiffness(&rod),
    }
}
