//! Bonds in the time step: their forces and damping, laws with a history, and breakage.

pub(crate) mod blocks;
pub mod breakage;
pub(crate) mod damage;
pub mod damping;
pub mod energy_kernel;
pub(crate) mod flat_joints;
pub mod forces;
pub mod incremental;
mod one_by_one;
pub(crate) mod plasticity;
pub(crate) mod structural_damping;
pub mod utilisation_kernel;
pub(crate) mod viscous_kernel;
