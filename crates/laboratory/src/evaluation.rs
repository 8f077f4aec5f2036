//! What the measured curve of each specimen says.

use crate::curve::Curve;
use crate::regions::Regions;
use crate::specimen::Specimen;

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
