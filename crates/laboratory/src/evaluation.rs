//! What the measured curve of each specimen says.

use crate::clipped::clipped;
use crate::curve::{Curve, FAILED};
use crate::outlier::outlier;
use crate::regions::Regions;
use crate::residual::{has_passed_its_peak, residual_n};
use crate::specimen::{Specimen, TestType};

/// Largest seating of a valid specimen, as a fraction of the travel at failure.
pub const LONGEST_SEATING: f64 = 0.25;
/// Fewest rows between contact and the largest force.
const FEWEST_LOADED: usize = 15;
/// A largest force that differs from the median of the others by this factor is in another unit.
const OTHER_UNIT: f64 = 100.0;

/// Young's moduli of materials, Pa.
const MODULI_PA: [f64; 2] = [1e3, 1e12];
/// Smallest strain at failure.
const LEAST_STRAIN: f64 = 1e-5;

/// A specimen as measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSpecimen {
    /// Name of its file.
    pub name: String,
    /// Type of test.
    pub test: TestType,
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
    /// Young's modulus by the crosshead travel, Pa. None for a disc, for a dog bone, whose wide
    /// ends yield as well, and for direct shear.
    pub young_modulus_pa: Option<f64>,
    /// Stress at the largest force, Pa.
    pub strength_pa: f64,
    /// Stress that is left at the end of a test under pressure, Pa. None: of other tests.
    pub residual_pa: Option<f64>,
    /// Travel at the largest force from where the fitted line has no force, m.
    pub travel_at_failure_m: f64,
    /// Why it is left out, a sentence each. Empty: it is valid.
    pub doubts: Vec<String>,
    /// What was assumed, and what sets it apart from others, a sentence each.
    pub notes: Vec<String>,
}

impl EvaluatedSpecimen {
    /// What was changed or assumed in reading and in evaluating it, a sentence each.
    pub fn all_notes(&self) -> Vec<String> {
        [self.measured.curve.notes.clone(), self.notes.clone()].concat()
    }
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
    leave_out_copies(&mut evaluated);
    name_outliers(&mut evaluated);
    evaluated
}

/// Leaves out specimens whose curve is that of another one before.
fn leave_out_copies(evaluated: &mut [EvaluatedSpecimen]) {
    for at in 1..evaluated.len() {
        let (before, rest) = evaluated.split_at_mut(at);
        let own = &rest[0].measured.curve;
        let is_same = |other: &&EvaluatedSpecimen| {
            let other = &other.measured.curve;
            other.travel_m == own.travel_m && other.force_n == own.force_n
        };
        if let Some(other) = before.iter().find(is_same) {
            let doubt = format!("it has the same rows as {}", other.measured.name);
            rest[0].doubts.push(doubt);
        }
    }
}

/// Adds notes to valid specimens that differ from the others.
fn name_outliers(evaluated: &mut [EvaluatedSpecimen]) {
    let valid: Vec<usize> = (0..evaluated.len())
        .filter(|at| evaluated[*at].doubts.is_empty())
        .collect();
    let strengths = valid.iter().map(|at| Some(evaluated[*at].strength_pa));
    let moduli = valid.iter().map(|at| evaluated[*at].young_modulus_pa);
    let quantities: [(&str, Option<Vec<f64>>); 2] = [
        ("strength", strengths.collect()),
        ("Young's modulus", moduli.collect()),
    ];
    for (what, values) in quantities {
        let Some(values) = values else { continue };
        for (at, specimen) in valid.iter().enumerate() {
            evaluated[*specimen]
                .notes
                .extend(outlier(&values, at, what));
        }
    }
}

/// Dimensions of which one is in another unit: by shape no specimen of its test is so long, wide
/// or thick.
fn odd_shape(measured: &MeasuredSpecimen) -> Option<String> {
    let (what, ratio, usual) = match measured.specimen {
        // A shear plane has no length.
        Specimen::Bar { .. } if measured.test == TestType::DirectShear => return None,
        Specimen::Bar { length_m, area_m2 } => {
            let usual = match measured.test {
                TestType::Tension | TestType::DogBone => [0.02, 2000.0],
                _ => [0.02, 50.0],
            };
            (
                "length over the side of its section",
                length_m / area_m2.sqrt(),
                usual,
            )
        }
        Specimen::Beam(beam) => (
            "width over its height",
            beam.width_m / beam.height_m,
            [0.02, 50.0],
        ),
        Specimen::Disc {
            diameter_m,
            thickness_m,
        } => (
            "thickness over its diameter",
            thickness_m / diameter_m,
            [0.01, 10.0],
        ),
    };
    let [least, most] = usual;
    (!(least..=most).contains(&ratio)).then(|| {
        format!("its {what} is {ratio:.3e} (usual: {least} to {most}): check its dimensions and their units")
    })
}

/// Numbers that no material has: a unit or a dimension is wrong.
fn impossible(
    measured: &MeasuredSpecimen,
    modulus_pa: Option<f64>,
    strength_pa: f64,
    travel_at_failure_m: f64,
) -> Vec<String> {
    let check = "check the units of travel and force and the dimensions";
    let mut found = Vec::from_iter(odd_shape(measured));
    let (strain, most) = match measured.specimen {
        // A shear plane has no strain.
        Specimen::Bar { .. } if measured.test == TestType::DirectShear => (LEAST_STRAIN, 1.0),
        Specimen::Bar { length_m, .. } => match measured.test {
            TestType::Tension | TestType::DogBone => (travel_at_failure_m / length_m, 10.0),
            _ => (travel_at_failure_m / length_m, 0.95),
        },
        Specimen::Beam(beam) => {
            if beam.height_m > beam.span_m {
                found.push(format!(
                    "its height of {} m is more than its support span of {} m: {check}",
                    beam.height_m, beam.span_m
                ));
            }
            (
                modulus_pa.map_or(f64::NAN, |modulus| strength_pa / modulus),
                1.0,
            )
        }
        Specimen::Disc { diameter_m, .. } => (travel_at_failure_m / diameter_m, 0.5),
    };
    if !(LEAST_STRAIN..=most).contains(&strain) {
        found.push(format!(
            "its strain at failure is {strain:.3e} (usual: {LEAST_STRAIN:e} to {most}), at a travel of {:.4} mm: {check}",
            1e3 * travel_at_failure_m
        ));
    }
    if let Some(modulus_pa) = modulus_pa
        && !(MODULI_PA[0]..=MODULI_PA[1]).contains(&modulus_pa)
    {
        found.push(format!(
            "its Young's modulus is {modulus_pa:.3e} Pa, not between 1 kPa and 1 TPa: {check}"
        ));
    }
    found
}

/// Force that is left at the end of a curve, N.
fn residual_of(measured: &MeasuredSpecimen, regions: &Regions) -> Option<f64> {
    let travel_m: Vec<f64> = (measured.curve.travel_m.iter())
        .map(|travel_m| travel_m - measured.curve.travel_m[0])
        .collect();
    residual_n(&travel_m, &regions.corrected_n)
}

/// Says that a specimen did not fail: its force does not fall, or, with a residual force, N, ends
/// at its peak.
fn not_failed(regions: &Regions, residual_n: Option<f64>) -> Option<String> {
    if let Some(residual_n) = residual_n {
        return (!has_passed_its_peak(residual_n, regions.largest_n)).then(|| {
            format!(
                "it did not pass its peak: the force is still {:.0} % of its largest at the end",
                100.0 * residual_n / regions.largest_n
            )
        });
    }
    let behind = &regions.corrected_n[regions.peak..];
    let least_n = behind
        .iter()
        .fold(f64::INFINITY, |least, force| least.min(*force));
    (least_n > FAILED * regions.largest_n).then(|| {
        format!(
            "it did not fail: the force is still {:.0} % of its largest at the end",
            100.0 * least_n / regions.largest_n
        )
    })
}

fn evaluate_one(measured: MeasuredSpecimen) -> EvaluatedSpecimen {
    let curve = &measured.curve;
    let regions = Regions::of(curve);
    let travel_at_failure_m = regions.travel_at_failure_m(curve);
    let has_residual = measured.test.has_residual();
    let mut notes = regions.notes.clone();
    // Shear boxes and cells load the specimen from the first row on, and soils yield early.
    let mut doubts = match has_residual {
        true => {
            notes.extend(regions.doubts_of_stiffness.clone());
            Vec::new()
        }
        false => regions.doubts_of_stiffness.clone(),
    };
    doubts.extend(regions.doubts.clone());
    doubts.extend(clipped(
        &curve.travel_m,
        &curve.force_n,
        &curve.lines,
        regions.stiffness_n_m,
    ));
    let loaded = regions.peak - regions.contact;
    if loaded < FEWEST_LOADED {
        doubts.push(format!(
            "only {loaded} rows lie between contact and the largest force"
        ));
    }
    let residual_n = residual_of(&measured, &regions);
    doubts.extend(not_failed(&regions, residual_n.filter(|_| has_residual)));
    let seating_m = regions.seating_m(curve);
    if !has_residual && seating_m > LONGEST_SEATING * travel_at_failure_m {
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
    let young_modulus_pa = (measured.specimen)
        .modulus_pa(regions.stiffness_n_m)
        .filter(|_| !matches!(measured.test, TestType::DogBone | TestType::DirectShear));
    let strength_pa = measured.specimen.stress_pa(regions.largest_n);
    doubts.extend(impossible(
        &measured,
        young_modulus_pa,
        strength_pa,
        travel_at_failure_m,
    ));
    EvaluatedSpecimen {
        young_modulus_pa,
        strength_pa,
        travel_at_failure_m,
        residual_pa: residual_n
            .filter(|_| has_residual)
            .map(|force_n| measured.specimen.stress_pa(force_n)),
        notes,
        regions,
        doubts,
        measured,
    }
}
