//! The file of a measured material.

use std::path::Path;

use dem_io::safe_write::{write_file, write_json_text};
use dem_io::{Diagnostic, Result};

use crate::material::{FORMAT_VERSION, MeasuredMaterial};
use crate::specimen::Specimen;

/// Writes a measured material as JSON, whole or not at all.
///
/// # Errors
/// Missing folder, no permission, full disk (all exit code 1).
pub fn write_material(path: &Path, material: &MeasuredMaterial) -> Result<()> {
    write_file(path, |out| write_json_text(out, material))
}

/// Reads what [`write_material`] wrote.
///
/// # Errors
/// No such file; it is not a measured material, or one of another version (all exit code 2).
pub fn read_material(path: &Path) -> Result<MeasuredMaterial> {
    let refuse = |problem: String| {
        let remedy = "name the file measured.json that dem-run lab wrote";
        Diagnostic::input(path.display().to_string(), problem, remedy)
    };
    let text = std::fs::read_to_string(path)
        .map_err(|error| refuse(format!("cannot be read: {error}")))?;
    let material: MeasuredMaterial = serde_json::from_str(&text)
        .map_err(|error| refuse(format!("is not a measured material: {error}")))?;
    if material.version != FORMAT_VERSION {
        return Err(refuse(format!(
            "has version {}, not {FORMAT_VERSION}",
            material.version
        )));
    }
    if material.curve.len() < 2 {
        return Err(refuse("has no curve".to_owned()));
    }
    Ok(material)
}

impl MeasuredMaterial {
    /// The mean curve of a specimen of other dimensions: displacement, m, and load, N. Empty if the
    /// dimensions of the material are incomplete.
    pub fn curve_of(&self, specimen: &Specimen) -> Vec<[f64; 2]> {
        let Ok(own) = Specimen::new(self.test, &self.dimensions) else {
            return Vec::new();
        };
        let factor = own.force_factor(specimen);
        let points = self.curve.iter();
        points
            .map(|point| [point.displacement_m, factor * point.load_n])
            .collect()
    }
}

/// Area between two curves up to the end of the first, over the area below the first. A curve
/// carries nothing outside its ends. Points: displacement, m, ascending, and load, N.
pub fn area_between(wanted: &[[f64; 2]], found: &[[f64; 2]]) -> f64 {
    let (Some(first), Some(last)) = (wanted.first(), wanted.last()) else {
        return f64::NAN;
    };
    let steps = 10 * wanted.len();
    let mut between = 0.0;
    let mut below = 0.0;
    for step in 0..steps {
        let x = first[0] + (step as f64 + 0.5) / steps as f64 * (last[0] - first[0]);
        let [wanted_n, found_n] = [wanted, found].map(|curve| load_n(curve, x));
        between += (found_n - wanted_n).abs();
        below += wanted_n.abs();
    }
    between / below
}

/// Load of a curve at a displacement, N; 0 outside its ends.
fn load_n(curve: &[[f64; 2]], x: f64) -> f64 {
    let next = curve.partition_point(|point| point[0] <= x);
    match (next.checked_sub(1).map(|at| curve[at]), curve.get(next)) {
        (Some(before), Some(after)) => {
            before[1] + (x - before[0]) / (after[0] - before[0]) * (after[1] - before[1])
        }
        _ => 0.0,
    }
}
