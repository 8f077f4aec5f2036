//! Clusters in the time step: the pieces into which they break.

pub mod bytes;
pub mod pieces;
