//! Contacts in the time step: between particles, within a piece, and liquid bridges.

pub(crate) mod bridges;
pub mod forces;
pub(crate) mod self_contact;
pub mod touching;
