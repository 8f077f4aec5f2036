//! The neighbour search: the Verlet list, and the lists that are made from it.

pub(crate) mod lists;
pub mod neighbours;
