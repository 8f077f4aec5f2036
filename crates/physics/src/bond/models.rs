//! Bond models, one per file.

pub mod elastic_solid;
pub mod euler_bernoulli;
pub mod flat_joint;
pub mod parallel;
pub mod pin;
pub mod rojek;
pub mod shear_coefficient;
pub mod timoshenko;
