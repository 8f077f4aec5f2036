//! Clusters: particles joined by bonds that are not broken (Platzer 2022, section 4.2).
//!
//! `detection` replaces algorithm 2 there, `triggers` algorithm 3.

mod detection;
pub mod fragments;
pub mod sizes;
pub(crate) mod triggers;

pub use detection::{Cluster, Clusters, Split};
pub use fragments::{Fragment, fragments};
pub use triggers::Triggers;
