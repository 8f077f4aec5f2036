//! Rigid clumps in the time step: their motion, their contacts, and their replacement by bonded
//! clusters.

pub(crate) mod contact_masses;
pub(crate) mod contact_stress;
pub mod motion;
pub(crate) mod replacement;
pub mod restoring;
pub(crate) mod rigid_parts;
pub(crate) mod touched;
pub mod zones;
