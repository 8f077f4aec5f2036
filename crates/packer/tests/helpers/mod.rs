//! What the tests share: solids, random numbers, lattices of spheres, and an oracle of packings
//! with a geometry of its own.

pub(crate) mod exact;
pub(crate) mod facets;
pub(crate) mod lattice;
pub(crate) mod packing;
pub(crate) mod random;
pub(crate) mod solids;
