//! What the valid specimens of a series say of their material.

use serde::{Deserialize, Serialize};

use crate::evaluation::EvaluatedSpecimen;
use crate::mean_curve::{CurvePoint, mean_curve};
use crate::specimen::{Dimensions, Specimen, TestType};
use crate::statistic::Statistic;

/// What a series of specimens says of their material: the target of simulated tests.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredMaterial {
    /// Version of this format.
    pub version: u32,
    /// Type of test.
    #[serde(rename = "type")]
    pub test: TestType,
    /// Dimensions to which all specimens were scaled.
    pub dimensions: Dimensions,
    /// Young's modulus by the crosshead travel, Pa. None for discs.
    pub young_modulus_pa: Option<Statistic>,
    /// Strength, Pa.
    pub strength_pa: Statistic,
    /// Stress that is left behind the peak of a test under pressure, Pa. None: of other tests.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub residual_pa: Option<Statistic>,
    /// Force over travel of the linear part, scaled, N/m.
    pub stiffness_n_m: Statistic,
    /// Largest force, scaled, N.
    pub failure_force_n: Statistic,
    /// Crosshead travel at the largest force, from where the linear part has no force, m.
    pub travel_at_failure_m: Statistic,
    /// Ends of the linear part as fractions of the largest force.
    pub linear_part: [Statistic; 2],
    /// The mean curve up to the mean travel at failure.
    pub curve: Vec<CurvePoint>,
    /// Files of the valid specimens.
    pub specimens: Vec<String>,
    /// Files of those left out, each with the reasons.
    pub left_out: Vec<(String, Vec<String>)>,
}

/// Version of the format of [`MeasuredMaterial`].
pub const FORMAT_VERSION: u32 = 1;

/// Puts valid specimens together, scaled to these dimensions. None: there are none.
pub fn material(
    test: TestType,
    dimensions: &Dimensions,
    reference: &Specimen,
    evaluated: &[EvaluatedSpecimen],
) -> Option<MeasuredMaterial> {
    let valid: Vec<&EvaluatedSpecimen> = evaluated
        .iter()
        .filter(|one| one.doubts.is_empty())
        .collect();
    if valid.is_empty() {
        return None;
    }
    let of = |value: &dyn Fn(&EvaluatedSpecimen) -> f64| {
        let values: Vec<f64> = valid.iter().map(|one| value(one)).collect();
        Statistic::of(&values)
    };
    let factor = |one: &EvaluatedSpecimen| one.measured.specimen.force_factor(reference);
    let moduli: Option<Vec<f64>> = valid.iter().map(|one| one.young_modulus_pa).collect();
    let residuals: Option<Vec<f64>> = valid.iter().map(|one| one.residual_pa).collect();
    let end_of_linear = |one: &EvaluatedSpecimen, row: usize| {
        (one.regions.corrected_n[row] / one.regions.largest_n).clamp(0.0, 1.0)
    };
    Some(MeasuredMaterial {
        version: FORMAT_VERSION,
        test,
        dimensions: *dimensions,
        young_modulus_pa: moduli.map(|moduli| Statistic::of(&moduli)),
        strength_pa: of(&|one| one.strength_pa),
        residual_pa: residuals.map(|residuals| Statistic::of(&residuals)),
        stiffness_n_m: of(&|one| factor(one) * one.regions.stiffness_n_m),
        failure_force_n: of(&|one| factor(one) * one.regions.largest_n),
        travel_at_failure_m: of(&|one| one.travel_at_failure_m),
        linear_part: [
            of(&|one| end_of_linear(one, one.regions.linear.start)),
            of(&|one| end_of_linear(one, one.regions.linear.end - 1)),
        ],
        curve: mean_curve(&valid, reference),
        specimens: valid.iter().map(|one| one.measured.name.clone()).collect(),
        left_out: evaluated
            .iter()
            .filter(|one| !one.doubts.is_empty())
            .map(|one| (one.measured.name.clone(), one.doubts.clone()))
            .collect(),
    })
}
