//! Pictures of particles and walls, drawn without any other program, and films of them.
//!
//! Equal input gives equal bytes. Nothing here panics: what is not finite is left out.

pub mod camera;
pub mod colours;
pub mod film;
pub mod image;
pub mod label;
pub mod png_file;
pub mod render;
pub mod subject;
pub mod surface;
mod vector;
pub mod view;

pub use camera::Camera;
pub use image::Image;
pub use render::{Ball, render};
pub use surface::Surface;
pub use view::View;
