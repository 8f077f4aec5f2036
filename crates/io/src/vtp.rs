//! Arrays of VTK XML PolyData (.vtp) by their names, in any uncompressed encoding, in one pass over
//! a file or a pipe. [`crate::vtk`] writes such files.

mod arrays;
mod decode;
mod guard;
mod header;
mod read;
mod shape;

pub(crate) use arrays::check_count;
pub use arrays::{Array, Arrays};
pub(crate) use decode::DAMAGED;
pub use read::Reader;
pub use shape::{Counts, Of, Shape};
