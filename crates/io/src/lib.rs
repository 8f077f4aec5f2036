//! What dem-pack and dem-run share: surfaces, bodies and their files. Nothing here knows an
//! algorithm of either program.
//!
//! Data flow: STL bytes -> [`stl`] facets -> [`surface`] welded, oriented shells; [`body`] <->
//! files; TOML -> [`scene`], [`study`]; what a run has to tell -> [`results`]; its state <->
//! [`checkpoint`]. Lengths are metres unless a name says otherwise.

pub mod body;
mod bounds;
pub mod boxes;
pub mod checkpoint;
pub mod diagnostic;
pub mod disjoint;
pub mod hash;
pub mod interpolation;
pub mod program;
pub mod random;
pub mod results;
pub mod safe_write;
pub mod scene;
pub mod stl;
pub mod surface;
pub mod text;
pub mod units;
pub mod vtk;
mod xml;

pub use body::Body;
pub use bounds::Bounds;
pub use diagnostic::{Diagnostic, Result};
pub use scene::{Scene, read_bodies, read_scene, scene_from_text, study};
pub use surface::Surface;
