//! A body: spheres, the bonds between them, and what is known of both.
//!
//! [`check`] holds the rules that every body keeps, [`files`] reads and writes bodies by the ending
//! of the file's name, [`summary`] says what a body holds, [`mass`] what it weighs.

pub mod check;
pub mod csv;
pub mod files;
pub mod inertia;
pub mod lammps;
pub mod mass;
mod parts;
pub mod stored_frame;
pub mod summary;
mod table;
pub mod txt;
pub mod vtp;

pub use files::{read_body, read_frame, write_body};
pub use parts::{About, Body};
pub use stored_frame::{StoredFragment, StoredFrame};
pub use summary::{BodySummary, body_summary};
