//! Elastic bonds between two spheres.

pub mod stiffness;
pub mod total;
