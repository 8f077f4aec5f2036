//! Cohesion and friction angle from strengths at several pressures, measured or simulated.

use dem_io::units::{show_quantity, significant};
use serde::Serialize;

use crate::fit::Line;
use crate::specimen::TestType;
use crate::student::student_95;
use crate::theory::mohr_coulomb_of_peaks;

/// The line of Mohr and Coulomb through the strengths of a body.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailureLine {
    /// Shear strength without normal stress, Pa.
    pub cohesion_pa: f64,
    /// Friction angle, degrees.
    pub friction_angle_deg: f64,
    /// Half the 95 % confidence intervals of cohesion, Pa, and friction angle, degrees (Student's
    /// t, by the errors of slope and intercept). None: of two strengths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub half_widths: Option<[f64; 2]>,
    /// Standard deviation of the strengths from the line, Pa.
    pub residual_pa: f64,
    /// Number of strengths.
    pub peaks: usize,
}

impl FailureLine {
    /// Through points of confining pressure and axial stress at failure of triaxial tests, or of
    /// normal stress and shear strength, Pa. None: points at fewer than two pressures, or strengths
    /// that do not rise with the pressure from above 0.
    pub fn of_peaks(is_triaxial: bool, points: &[[f64; 2]]) -> Option<Self> {
        let (pressures, strengths): (Vec<f64>, Vec<f64>) = points
            .iter()
            .map(|[pressure, strength]| (*pressure, *strength))
            .unzip();
        if pressures.iter().all(|pressure| *pressure == pressures[0]) {
            return None;
        }
        let line = Line::fitted(&pressures, &strengths);
        let intercept_pa = line.at_x0 - line.slope * line.x0;
        if !(line.slope > 0.0 && intercept_pa > 0.0) {
            return None;
        }
        let (cohesion_pa, angle_rad) = match is_triaxial {
            true => mohr_coulomb_of_peaks(line.slope, intercept_pa),
            false => (intercept_pa, line.slope.atan()),
        };
        Some(Self {
            cohesion_pa,
            friction_angle_deg: angle_rad.to_degrees(),
            half_widths: half_widths(is_triaxial, &line, points.len()),
            residual_pa: line.residual,
            peaks: pressures.len(),
        })
    }

    /// Through points of pressure and strength, Pa, the load over the area in both tests: in
    /// triaxial compression the pressure adds to it.
    pub fn of_strengths(kind: TestType, points: &[[f64; 2]]) -> Option<Self> {
        let is_triaxial = kind == TestType::TriaxialCompression;
        let axial = |[pressure, strength]: &[f64; 2]| match is_triaxial {
            true => [*pressure, pressure + strength],
            false => [*pressure, *strength],
        };
        let points: Vec<[f64; 2]> = points.iter().map(axial).collect();
        Self::of_peaks(is_triaxial, &points)
    }

    /// The strength, the load over the area, that the line has under a pressure, Pa.
    pub fn strength_pa(&self, test: Option<TestType>, pressure_pa: f64) -> f64 {
        let (sin, cos) = self.friction_angle_deg.to_radians().sin_cos();
        match test {
            Some(TestType::TriaxialCompression) => {
                2.0 * (self.cohesion_pa * cos + pressure_pa * sin) / (1.0 - sin)
            }
            _ => self.cohesion_pa + pressure_pa * sin / cos,
        }
    }

    /// As a sentence.
    pub fn note(&self) -> String {
        let line = format!(
            "cohesion {} and friction angle {} degrees, from the line through {} strengths",
            show_quantity(self.cohesion_pa, "Pa"),
            significant(self.friction_angle_deg, 4),
            self.peaks,
        );
        let Some([cohesion_pa, angle_deg]) = self.half_widths else {
            return line;
        };
        format!(
            "{line}, which deviate from it by {} (95 %: ± {}, ± {} degrees)",
            show_quantity(self.residual_pa, "Pa"),
            show_quantity(cohesion_pa, "Pa"),
            significant(angle_deg, 2)
        )
    }
}

/// Half the 95 % confidence intervals of cohesion, Pa, and friction angle, degrees, by the
/// derivatives of both over slope and intercept, whose errors are correlated.
fn half_widths(is_triaxial: bool, line: &Line, count: usize) -> Option<[f64; 2]> {
    if count < 3 {
        return None;
    }
    let (slope, intercept) = (line.slope, line.at_x0 - line.slope * line.x0);
    let slope_2 = line.slope_error.powi(2);
    let middle_2 = line.residual.powi(2) / count as f64;
    // The errors of the slope and of the value at the mean pressure are independent.
    let error = |over_slope: f64, over_intercept: f64| {
        let of_slope = over_slope - over_intercept * line.x0;
        (slope_2 * of_slope.powi(2) + middle_2 * over_intercept.powi(2)).sqrt()
    };
    let (cohesion, angle) = match is_triaxial {
        true => {
            let root = slope.sqrt();
            let over_slope = -intercept / (4.0 * slope * root);
            (
                error(over_slope, 0.5 / root),
                error(1.0 / (root * (1.0 + slope)), 0.0),
            )
        }
        false => (error(0.0, 1.0), error(1.0 / (1.0 + slope * slope), 0.0)),
    };
    let t = student_95(count - 2);
    Some([t * cohesion, (t * angle).to_degrees()])
}
