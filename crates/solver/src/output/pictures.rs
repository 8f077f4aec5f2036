//! Pictures of a state: what of it is to be seen, and from where.

pub mod subject;
pub mod view;

pub use view::View;
