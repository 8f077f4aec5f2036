//! What dem-pack and dem-run share: surfaces, bodies and their files. Nothing here knows an
//! algorithm of either program.
//!
//! Data flow: bytes of an STL, OBJ, PLY or 3MF -> facets ([`triangles`]) -> [`surface`] welded,
//! oriented shells; [`body`] <-> files. Lengths are metres unless a name says otherwise.

pub mod body;
mod bounds;
pub mod boxes;
pub mod diagnostic;
pub mod disjoint;
pub mod hash;
mod input_file;
pub mod interpolation;
pub mod lines;
pub mod own_command;
pub mod random;
pub mod safe_write;
pub mod sieve_curve;
pub mod stl;
pub mod surface;
pub mod text;
pub mod triangles;
pub mod units;
pub mod vtk;
pub mod vtp;
pub mod whole_folder;
pub mod write_target;
mod xml;

pub use body::Body;
pub use bounds::Bounds;
pub use diagnostic::{Diagnostic, Result};
pub use input_file::{explain_read, open_input, read_input};
pub use surface::Surface;
