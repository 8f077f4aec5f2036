//! Bodies that enter, leave or are replaced.

pub(crate) mod absorbed_energy;
mod append;
pub mod change;
pub(crate) mod daughters;
pub(crate) mod flow;
pub mod inlets;
mod outlets;
