//! Pictures of a state: the visible objects, and the view.

pub(crate) mod reach;
mod region_names;
pub mod scale;
pub mod subject;
pub(crate) mod view;

pub(crate) use subject::around_walls;
pub use view::View;
