//! Pictures of spheres and surfaces, drawn without other programs, and films of them.
//!
//! [`Camera`] defines the view, [`render()`] draws [`Ball`]s and [`Surface`]s into an [`Image`],
//! [`label`] writes the time and a scale into it, [`png_file`], [`film`] and [`animation`] make
//! files.
//!
//! Equal input gives equal bytes. Nothing here panics: values that are not finite are ignored.

pub mod animation;
pub(crate) mod camera;
pub mod colours;
pub mod film;
pub(crate) mod image;
pub mod label;
pub(crate) mod palette;
pub mod png_file;
pub mod render;
pub mod surface;
mod vector;

pub use camera::Camera;
pub use image::Image;
pub use render::{Ball, render};
pub use surface::Surface;
