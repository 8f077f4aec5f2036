//! From measured curves to what they say of a material: each specimen, then all of them.

use serde::{Deserialize, Serialize};

use crate::curve::Curve;
use crate::fit::mean;
use crate::mean_curve::{CurvePoint, mean_curve};
use crate::regions::Regions;
use crate::specimen::{Dimensions, Specimen, TestType};

/// Largest seating of a valid specimen, as a fraction of the travel at failure.
pub const LONGEST_SEATING: f64 = 0.25;
/// A specimen has failed where the force falls below this fraction of its largest.
pub const FAILED: f64 = 0.75;
/// Fewest rows between contact and the largest force.
const FEWEST_LOADED: usize = 15;
/// A largest force that differs from the median of the others by this factor is in another unit.
const OTHER_UNIT: f64 = 100.0;

/// A specimen as measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSpecimen {
    /// Name of its file.
    pub name: String,
    /// Its own dimensions.
    pub specimen: Specimen,
    /// Distance of its crack from the middle, m. None: not known.
    pub crack_m: Option<f64>,
    /// The curve.
    pub curve: Curve,
}

/// What the curve of a specimen says.
#[derive(Debug, Clone, PartialEq)]
pub struct EvaluatedSpecimen {
    /// As measured.
    pub measured: MeasuredSpecimen,
    /// Regions of the curve.
    pub regions: Regions,
    /// Young's modulus by the crosshead travel, Pa. None for a disc.
    pub young_modulus_pa: Option<f64>,
    /// Stress at the largest force, Pa.
    pub strength_pa: f64,
    /// Travel at the largest force from where the fitted line has no force, m.
    pub travel_at_failure_m: f64,
    /// Why it is left out, a sentence each. Empty: it is valid.
    pub doubts: Vec<String>,
}

/// Mean and scatter of a number over specimens.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation of single specimens (n - 1); 0 for one.
    pub standard_deviation: f64,
    /// Number of specimens.
    pub count: usize,
}

impl Statistic {
    /// Of values; at least one.
    pub fn of(values: &[f64]) -> Self {
        let mean = mean(values);
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let count = values.len();
        let standard_deviation = (squares / (count as f64 - 1.0).max(1.0)).sqrt();
        Self {
            mean,
            standard_deviation,
            count,
        }
    }
}

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

/// Evaluates each specimen; those in doubt are named by their doubts.
pub fn evaluate(specimens: Vec<MeasuredSpecimen>) -> Vec<EvaluatedSpecimen> {
    let mut evaluated: Vec<EvaluatedSpecimen> = specimens.into_iter().map(evaluate_one).collect();
    let mut largest: Vec<f64> = evaluated.iter().map(|one| one.regions.largest_n).collect();
    largest.sort_by(f64::total_cmp);
    for one in &mut evaluated {
        let usual_n = largest[largest.len() / 2];
        let factor = one.regions.largest_n / usual_n;
        if !(1.0 / OTHER_UNIT..=OTHER_UNIT).contains(&factor) {
            one.doubts.push(format!(
                "its largest force is {:.4} N, that of others {usual_n:.4} N: one of them is in another unit",
                one.regions.largest_n
            ));
        }
    }
    evaluated
}

fn evaluate_one(measured: MeasuredSpecimen) -> EvaluatedSpecimen {
    let curve = &measured.curve;
    let regions = Regions::of(curve);
    let travel_at_failure_m = regions.travel_at_failure_m(curve);
    let mut doubts = regions.doubts.clone();
    let loaded = regions.peak - regions.contact;
    if loaded < FEWEST_LOADED {
        doubts.push(format!(
            "only {loaded} rows lie between contact and the largest force"
        ));
    }
    let behind = &regions.corrected_n[regions.peak..];
    let least_n = behind
        .iter()
        .fold(f64::INFINITY, |least, force| least.min(*force));
    if least_n > FAILED * regions.largest_n {
        doubts.push(format!(
            "it did not fail: the force is still {:.0} % of its largest at the end",
            100.0 * least_n / regions.largest_n
        ));
    }
    let seating_m = regions.seating_m(curve);
    if seating_m > LONGEST_SEATING * travel_at_failure_m {
        doubts.push(format!(
            "its seating takes {:.3} mm, {:.0} % of the travel at failure",
            1e3 * seating_m,
            100.0 * seating_m / travel_at_failure_m
        ));
    }
    if let (Some(crack_m), Some(within_m)) = (measured.crack_m, measured.specimen.crack_within_m())
        && crack_m.abs() > within_m
    {
        doubts.push(format!(
            "it cracked {:.1} mm from the middle, outside the loading pins at {:.1} mm",
            1e3 * crack_m.abs(),
            1e3 * within_m
        ));
    }
    EvaluatedSpecimen {
        young_modulus_pa: measured.specimen.modulus_pa(regions.stiffness_n_m),
        strength_pa: measured.specimen.stress_pa(regions.largest_n),
        travel_at_failure_m,
        regions,
        doubts,
        measured,
    }
}

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
    let end_of_linear = |one: &EvaluatedSpecimen, row: usize| {
        (one.regions.corrected_n[row] / one.regions.largest_n).clamp(0.0, 1.0)
    };
    Some(MeasuredMaterial {
        version: FORMAT_VERSION,
        test,
        dimensions: *dimensions,
        young_modulus_pa: moduli.map(|moduli| Statistic::of(&moduli)),
        strength_pa: of(&|one| one.strength_pa),
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
