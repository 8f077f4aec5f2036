//! The shape: a file of triangles or standard input.

use super::arguments::Reading;
use crate::sizes::Sizes;
use dem_io::surface::{self, ReadSettings};
use dem_io::triangles::{read_stream, read_triangle_file};
use dem_io::units::{length_unit_m, show_length};
use dem_io::{Diagnostic, Result, Surface, explain_read};
use std::path::Path;

/// The surface of the shape in a file, or in standard input (`-`).
pub(super) fn read_surface(path: &Path, reading: &Reading) -> Result<Surface> {
    if !(reading.scale > 0.0 && reading.scale.is_finite()) {
        return Err(Diagnostic::input(
            "--scale",
            format!("{} is not a positive number", reading.scale),
            "1 leaves the shape as it is",
        ));
    }
    let unit = reading.unit.as_deref();
    let unit_m = unit.map(length_unit_m).transpose();
    let unit_m = unit_m.map_err(|e| e.within("--unit"))?;
    let (name, bytes) = if path == Path::new("-") {
        read_stream(&mut std::io::stdin().lock()).map(|bytes| ("standard input".to_owned(), bytes))
    } else {
        read_triangle_file(path).map(|bytes| (path.display().to_string(), bytes))
    }
    .map_err(|error| explain_read(path, &error, "a file"))?;
    surface::read_surface(
        &bytes,
        &name,
        ReadSettings {
            unit_m,
            scale: reading.scale,
            fill_holes: reading.fill_holes,
        },
    )
}

/// Refuses a diameter without a unit that is larger than the shape, which was hardly meant in
/// metres.
pub(super) fn check_unit_of_diameter(
    text: Option<&str>,
    sizes: &Sizes,
    surface: &Surface,
) -> Result<()> {
    let text = text.unwrap_or_default();
    let numbers = text.rsplit(':').next().unwrap_or(text);
    let has_unit = numbers
        .chars()
        .any(|c| c.is_alphabetic() && !matches!(c, 'e' | 'E'));
    let longest = surface.extent().iter().copied().fold(0.0, f64::max) * surface.unit_m;
    if has_unit || sizes.min_m() <= longest {
        return Ok(());
    }
    Err(Diagnostic::input(
        format!("--diameter '{text}'"),
        format!(
            "no sphere fits: {} is larger than the shape, which is {} long",
            show_length(sizes.min_m()),
            show_length(longest)
        ),
        "a number without a unit is metres: write one, such as 2mm..3mm",
    ))
}
