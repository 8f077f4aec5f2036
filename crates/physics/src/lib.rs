//! Physics as functions of plain numbers, independent of storage, threads, files and scenes: laws
//! of bonds and contacts, rotation, shapes of walls, and bodies made of spheres.

pub mod bending;
pub mod bond;
pub mod breakage;
pub mod chebyshev;
pub mod clump_stress;
pub mod contact;
pub mod dual;
pub mod geometry;
pub mod lanes;
pub mod machine;
pub mod number;
pub mod remembered;
pub mod rigid;
pub mod rotation;
pub mod shape;
pub mod wall_load;
