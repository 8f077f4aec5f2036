//! Pictures of a state: the visible objects, and the view.

pub(crate) mod reach;
pub mod scale;
pub(crate) mod subject;
pub(crate) mod view;

pub use view::View;
