//! Clusters: particles joined by bonds that are not broken (Platzer 2022, section 4.2).
//!
//! `detection` replaces algorithm 2 there. Algorithm 3, which decides when to search, is not
//! needed:
//! a piece is searched in each step in which a bond of it breaks.

mod detection;
pub mod fragments;
pub mod sizes;

pub use detection::{Cluster, Clusters, Split};
pub use fragments::{Fragment, fragments};
