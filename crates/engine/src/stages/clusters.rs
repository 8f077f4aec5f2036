//! Clusters in the time step: the pieces into which they break.

pub(crate) mod bytes;
pub mod pieces;
