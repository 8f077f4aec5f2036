//! Cohesion and friction angle of a body, from its strengths at several pressures.

use dem_io::units::{STRESS, quantity};
use dem_laboratory::FailureLine;
use dem_laboratory::theory::{PEAK_AXIAL_STRESS, PEAK_SHEAR_STRESS};
use dem_scene::study::{Axis, MeasureOf, Study};

use super::row::Row;

/// For a study that varies the confining pressure of triaxial tests and measures the axial stress
/// at failure, or varies the normal stress of shear tests and measures the strength; nothing else
/// varies but the axis that is averaged over. None: another study, strengths at fewer than two
/// pressures, or strengths that do not rise with the pressure from above 0.
pub(crate) fn failure_line(study: &Study, rows: &[Row]) -> Option<FailureLine> {
    let axes = || study.axes.iter().enumerate();
    let is_other = |at: usize| Some(at) != study.average_over;
    let (at, axis) = axes().find(|(at, _)| is_other(*at))?;
    if axes().filter(|(at, _)| is_other(*at)).count() > 1 {
        return None;
    }
    let is_triaxial = axis.name == "test.confining_pressure";
    let wanted = match axis.name.as_str() {
        "test.confining_pressure" => PEAK_AXIAL_STRESS,
        "test.normal_stress" => PEAK_SHEAR_STRESS,
        _ => return None,
    };
    let is_strength = |of: &MeasureOf| matches!(of, MeasureOf::Figure(name) if name == wanted);
    let measure = study.measures.iter().position(|one| is_strength(&one.of))?;
    let points = rows.iter().filter_map(|row| {
        let strength_pa = row.results.get(measure)?.value;
        Some([pressure_pa(axis, row.choice[at])?, strength_pa])
    });
    FailureLine::of_peaks(is_triaxial, &points.collect::<Vec<_>>())
}

/// The value of the axis, Pa.
fn pressure_pa(axis: &Axis, choice: usize) -> Option<f64> {
    let (number, unit) = axis.values[choice].number.as_ref()?;
    if unit.is_empty() {
        return Some(*number);
    }
    quantity(&format!("{number} {unit}"), &STRESS).ok()
}
