//! Bond models, one per file.

pub(crate) mod elastic_solid;
pub(crate) mod euler_bernoulli;
pub(crate) mod flat_joint;
pub(crate) mod parallel;
pub(crate) mod pin;
pub(crate) mod rojek;
pub(crate) mod shear_coefficient;
pub(crate) mod timoshenko;
