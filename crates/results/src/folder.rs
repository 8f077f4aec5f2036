//! The folder of a run: the names in it, and its permitted previous contents.

mod create;
mod disk;
mod lock;
mod look;
pub mod names;
mod paths;
mod remove;
mod write;

pub use create::Existing;
pub use disk::make_folder;
pub use lock::{is_locked, is_written_to, lock_file};
pub use look::{frames_in, refuse_inputs_among_results, result_among};
pub(super) use names::{fixed_walls_name, frame_name, loads_name, walls_name};
pub use names::{frame_in, loads_file, walls_in};
pub use paths::ResultsFolder;
