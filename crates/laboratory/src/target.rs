//! The file of a measured material.

use std::path::Path;

use dem_io::safe_write::write_file;
use dem_io::safe_write::write_json_text;
use dem_io::{Diagnostic, Result, read_input};

use crate::material::{FORMAT_VERSION, MeasuredMaterial};
use crate::specimen::Specimen;

/// Writes a measured material as JSON, whole or not at all.
pub fn write_material(path: &Path, material: &MeasuredMaterial) -> Result<()> {
    write_file(path, |out| write_json_text(out, material))
}

/// Reads what [`write_material`] wrote; refuses other files, other versions, and a material without
/// a curve.
pub fn read_material(path: &Path) -> Result<MeasuredMaterial> {
    let refuse = |problem: String| {
        let remedy = "name the file measured.json that dem-run lab wrote";
        Diagnostic::input(path.display().to_string(), problem, remedy)
    };
    let bytes = read_input(path, "a measured material")?;
    let material: MeasuredMaterial = serde_json::from_slice(&bytes)
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

    /// The mean stiffness of a specimen of other dimensions, N/m. None: the dimensions of the
    /// material are incomplete.
    pub fn stiffness_of(&self, specimen: &Specimen) -> Option<f64> {
        let own = Specimen::new(self.test, &self.dimensions).ok()?;
        Some(own.force_factor(specimen) * self.stiffness_n_m.mean)
    }
}
