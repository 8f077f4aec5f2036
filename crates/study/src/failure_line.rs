//! Cohesion and friction angle of a body, from its strengths at several pressures.

use dem_io::units::{STRESS, quantity, show_quantity, significant};
use dem_laboratory::Line;
use dem_laboratory::theory::{PEAK_AXIAL_STRESS, PEAK_SHEAR_STRESS, mohr_coulomb_of_peaks};
use dem_scene::study::{Axis, MeasureOf, Study};
use serde::Serialize;

use super::row::Row;

/// The line of Mohr and Coulomb through the strengths of a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailureLine {
    /// Shear strength without normal stress, Pa.
    pub cohesion_pa: f64,
    /// Friction angle, degrees.
    pub friction_angle_deg: f64,
    /// Standard deviation of the strengths from the line, Pa.
    pub residual_pa: f64,
    /// Number of strengths.
    pub peaks: usize,
}

impl FailureLine {
    /// For a study that varies the confining pressure of triaxial tests and measures the axial
    /// stress at failure, or varies the normal stress of shear tests and measures the strength;
    /// nothing else varies but the axis that is averaged over. None: another study, strengths at
    /// fewer than two pressures, or strengths that do not rise with the pressure from above 0.
    pub(crate) fn of(study: &Study, rows: &[Row]) -> Option<Self> {
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
            Some((pressure_pa(axis, row.choice[at])?, strength_pa))
        });
        let (pressures, strengths): (Vec<f64>, Vec<f64>) = points.unzip();
        if pressures.iter().all(|pressure| *pressure == pressures[0]) {
            return None;
        }
        let line = Line::fitted(&pressures, &strengths);
        let intercept_pa = line.at_x0 - line.slope * line.x0;
        if !(line.slope > 0.0 && intercept_pa > 0.0) {
            return None;
        }
        let (cohesion_pa, angle_rad) = if is_triaxial {
            mohr_coulomb_of_peaks(line.slope, intercept_pa)
        } else {
            (intercept_pa, line.slope.atan())
        };
        Some(Self {
            cohesion_pa,
            friction_angle_deg: angle_rad.to_degrees(),
            residual_pa: line.residual,
            peaks: pressures.len(),
        })
    }

    /// As a sentence.
    pub(crate) fn note(&self) -> String {
        let line = format!(
            "cohesion {} and friction angle {} degrees, from the line through {} strengths",
            show_quantity(self.cohesion_pa, "Pa"),
            significant(self.friction_angle_deg, 4),
            self.peaks,
        );
        if self.peaks < 3 {
            return line;
        }
        let off = show_quantity(self.residual_pa, "Pa");
        format!("{line}, which deviate from it by {off}")
    }
}

/// The value of the axis, Pa.
fn pressure_pa(axis: &Axis, choice: usize) -> Option<f64> {
    let (number, unit) = axis.values[choice].number.as_ref()?;
    if unit.is_empty() {
        return Some(*number);
    }
    quantity(&format!("{number} {unit}"), &STRESS).ok()
}
