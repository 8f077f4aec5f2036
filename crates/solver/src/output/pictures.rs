//! Pictures of a state: the visible objects, and the view.

pub mod subject;
pub mod view;

pub use view::View;
