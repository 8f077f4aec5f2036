//! Shapes of `data/shapes`, and spheres for them.

use dem_io::surface::{ReadSettings, Surface, read_surface};
use dem_pack::{Basis, Sizes};

use crate::bench::{Failed, root};

/// A shape, its millimetres times `scale`.
pub(crate) fn shape(name: &str, scale: f64) -> Result<Surface, Failed> {
    let file = format!("data/shapes/{name}.stl");
    surface_of(&std::fs::read(root().join(&file))?, &file, scale)
}

/// As [`shape`], from the bytes of a file.
pub(crate) fn surface_of(stl: &[u8], name: &str, scale: f64) -> Result<Surface, Failed> {
    let reading = ReadSettings {
        unit_m: Some(1e-3),
        scale,
        fill_holes: false,
    };
    Ok(read_surface(stl, name, reading)?)
}

/// Diameters by number.
pub(crate) fn sizes(diameters: &str) -> Result<Sizes, Failed> {
    Ok(Sizes::parse(diameters, Basis::Number)?)
}
