//! What `dem-run lab` says of specimens and their material.

use std::io::Write;

use dem_io::text::visible;
use dem_io::units::show_quantity;
use dem_laboratory::{EvaluatedSpecimen, MeasuredMaterial, statistics};
use serde_json::json;

/// A specimen with what speaks against it.
pub(super) fn doubts_of(one: &EvaluatedSpecimen) -> String {
    format!("{}: {}", one.measured.name, one.doubts.join("; "))
}

/// Numbers of a material and of its specimens.
pub(super) fn summary(
    found: &MeasuredMaterial,
    evaluated: &[EvaluatedSpecimen],
) -> serde_json::Value {
    let specimens: Vec<serde_json::Value> = evaluated
        .iter()
        .map(|one| {
            let regions = &one.regions;
            json!({
                "file": one.measured.name,
                "young_modulus_pa": one.young_modulus_pa,
                "strength_pa": one.strength_pa,
                "residual_pa": one.residual_pa,
                "failure_force_n": regions.largest_n,
                "travel_at_failure_m": one.travel_at_failure_m,
                "stiffness_n_m": regions.stiffness_n_m,
                "seating_m": regions.seating_m(&one.measured.curve),
                "offset_n": regions.offset_n,
                "drift_n_m": regions.drift_n_m,
                "noise_n": regions.noise_n,
                "notes": one.all_notes(),
                "left_out": one.doubts,
            })
        })
        .collect();
    json!({ "material": found, "specimens": specimens })
}

/// Prints what is said of the specimens, and the statistics of their material.
pub(super) fn print_series(
    out: &mut dyn Write,
    found: Option<&MeasuredMaterial>,
    evaluated: &[EvaluatedSpecimen],
) -> std::io::Result<()> {
    for one in evaluated {
        for note in &one.all_notes() {
            writeln!(out, "note         {}: {note}", visible(&one.measured.name))?;
        }
        if !one.doubts.is_empty() {
            writeln!(out, "left out     {}", visible(&doubts_of(one)))?;
        }
    }
    let count = found.map_or(0, |found| found.specimens.len());
    writeln!(out, "specimens    {count} of {} valid", evaluated.len())?;
    for (name, unit, value) in found.map(statistics).unwrap_or_default() {
        let mean = show_quantity(value.mean, unit);
        let scatter = show_quantity(value.standard_deviation, unit);
        writeln!(out, "{name:27}  {mean}, standard deviation {scatter}")?;
    }
    Ok(())
}
