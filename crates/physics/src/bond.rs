//! Elastic bonds between two spheres.

pub mod bearing_section;
pub mod causes;
pub mod criteria;
pub mod damage;
pub mod damping;
pub mod damping_models;
pub mod failure;
pub mod flat_joint;
pub mod incremental;
pub mod models;
pub mod pair;
pub mod plasticity;
pub mod rate_strengthening;
pub mod rod;
pub mod scatter;
pub mod stiffness;
pub mod strain_rate;
pub mod stresses;
pub mod tangent;
pub mod total;

/// Load of a bond.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BondLoad<T = f64> {
    /// Along the bond, tension positive, N.
    pub normal_n: T,
    /// Across it, N. Not negative.
    pub shear_n: T,
    /// Torsional moment, N m. Not negative.
    pub torsion_n_m: T,
    /// Bending moment, N m. Not negative.
    pub bending_n_m: T,
}
