//! Bond models, one per file.

pub mod elastic_solid;
pub mod euler_bernoulli;
pub mod parallel;
pub mod shear_coefficient;
pub mod timoshenko;
