//! A body: spheres, the bonds between them, and information on both.
//!
//! `check` contains the rules for every body, [`files`] reads and writes bodies by the ending of
//! the file's name, `summary` lists the contents of a body, [`mass`] computes its mass.

pub(crate) mod check;
mod coarse;
pub mod csv;
pub mod files;
pub mod histories;
pub mod inertia;
pub mod lammps;
pub mod mass;
mod parts;
pub mod stored_frame;
pub mod stored_particles;
pub mod stored_walls;
mod strain;
pub(crate) mod summary;
mod table;
pub mod txt;
pub mod vtp;

pub use coarse::{ENOUGH_ACROSS, few_across};
pub use files::{read_body, read_frame, read_particles, read_spheres, read_walls, write_body};
pub use histories::BondColumn;
pub use parts::{About, Body};
pub use stored_frame::{NO_FRAME, StoredFragment, StoredFrame};
pub use stored_particles::StoredParticles;
pub use stored_walls::StoredWalls;
pub use summary::{BodySummary, body_summary};
