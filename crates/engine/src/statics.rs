//! Static equilibrium without steps, by Newton's method.

pub mod conjugate;
pub mod contacts;
pub mod degrees_of_freedom;
pub mod direct;
pub mod displacements;
pub mod estimate;
pub mod factor;
pub mod matrix;
pub mod newton;

pub use estimate::StaticsEstimate;
pub use newton::{Cause, Equilibrium, Unsolved, equilibrium};
