//! The bond models: the one place that lists them. See `doc/inside/adding-a-model.md` for how to
//! add another.

use super::models::elastic_solid::ElasticSolid;
use super::models::euler_bernoulli::EulerBernoulli;
use super::models::flat_joint::FlatJoint;
use super::models::parallel::Parallel;
use super::models::pin::Pin;
use super::models::rojek::Rojek;
use super::models::shear_coefficient::ShearCoefficient;
use super::models::timoshenko::Timoshenko;
pub use super::rod::{BondShape, Stiffness};
use super::rod::{Rod, RodModel};

/// Beam model of a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BondModel {
    /// Parallel bond: shear stiffness is the normal stiffness divided by `kappa`, 2 (1 + nu) unless
    /// given. Shear acts halfway between the surfaces of the spheres.
    Parallel {
        /// Ratio of normal to shear stiffness.
        kappa: Option<f64>,
    },
    /// As the parallel bond, without moments.
    Pin {
        /// Ratio of normal to shear stiffness.
        kappa: Option<f64>,
    },
    /// Two segments in series, each as thick as its sphere.
    Rojek {
        /// Ratio of normal to shear stiffness.
        kappa: Option<f64>,
    },
    /// Slender beam: no shear deformation.
    EulerBernoulli,
    /// Beam with shear deformation, shear form factor 10/9.
    Timoshenko,
    /// MUSEN's bond: each mode as for a rod of the bond's length.
    ElasticSolid,
    /// Beam of Platzer 2022: like the elastic solid bond, with the shear stiffness multiplied by a
    /// coefficient.
    ShearCoefficient {
        /// Shear coefficient, 0.9 for a circular section.
        alpha: f64,
    },
    /// Flat joint: see [`flat_joint`](super::flat_joint).
    FlatJoint {
        /// Ratio of normal to shear stiffness.
        kappa: Option<f64>,
        /// Second moment of the elements over that of the disc.
        moment_ratio: f64,
    },
}

/// Stiffness of a bond with Young's modulus `young_modulus_pa` and Poisson's ratio `poisson_ratio`.
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
        BondModel::Pin { kappa } => Pin { kappa }.stiffness(&rod),
        BondModel::Rojek { kappa } => Rojek { kappa }.stiffness(&rod),
        BondModel::EulerBernoulli => EulerBernoulli.stiffness(&rod),
        BondModel::Timoshenko => Timoshenko.stiffness(&rod),
        BondModel::ElasticSolid => ElasticSolid.stiffness(&rod),
        BondModel::FlatJoint {
            kappa,
            moment_ratio,
        } => FlatJoint {
            kappa,
            moment_ratio,
        }
        .stiffness(&rod),
        BondModel::ShearCoefficient { alpha } => ShearCoefficient { alpha }.stiffness(&rod),
    }
}
