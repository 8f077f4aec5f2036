//! Helpers shared by the tests: solids, lattices of spheres, and an independent check of
//! packings with its own geometry.

pub(crate) mod exact;
pub(crate) mod facets;
pub(crate) mod lattice;
pub(crate) mod packing;
pub(crate) mod solids;
