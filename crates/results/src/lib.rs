//! Results of a run: a folder of frames, time series, events, fragments, plots and a summary.
//!
//! A crash or a full disk never destroys existing results: files appear complete or not at all, and
//! tables grow by complete rows. A run that was interrupted and continued writes the same bytes as
//! one that was not.

pub mod arrays;
pub mod checkpoint;
pub mod columns;
pub(crate) mod discharge;
mod discharged;
pub(crate) mod events;
pub(crate) mod flows;
pub mod folder;
pub(crate) mod fragments;
pub(crate) mod frames;
mod growing;
pub(crate) mod json;
pub(crate) mod pictures;
pub(crate) mod plot_file;
pub(crate) mod series;
pub mod summary;
pub(crate) mod wall_loads;
pub(crate) mod walls;

pub use arrays::{Array, Arrays, read_all_arrays, read_arrays};
pub use discharge::{DischargeRow, DistributionRow};
pub use discharged::{SievedPieces, discharged};
pub use events::{Event, event_lines, read_strengthened};
pub use flows::{FlowRow, MixingRow};
pub use folder::{Existing, ResultsFolder};
pub use fragments::{FragmentRow, TreeRow, append_fragments};
pub use frames::{Frame, FrameFiles, NamedArray, Values, WallFiles, write_frame};
pub use growing::Table;
pub use json::{from_json, write_json};
pub use pictures::PictureFiles;
pub use plot_file::{is_plot_file, write_plot_file};
pub use series::{Series, SeriesFile, read_series};
pub use summary::{Balance, Summary};
pub use wall_loads::{WallPatch, write_wall_load_cells, write_wall_loads};
pub use walls::{WallFrame, WallTriangles};
