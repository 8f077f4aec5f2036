//! Results of a test from force and displacement: stiffness, modulus, strength, position of the
//! crack.

use dem_io::units::{self, Dimension, show_quantity};
use dem_scene::{BondKind, Test};

use super::confined::{self, POISSON_RATIO, RESIDUAL, RESIDUAL_FRICTION};
use super::curve::{earlier_peak, largest_n, peak, play_m, rows_of, slope};
use super::disc_stress::{self, ACROSS, ALONG};
use super::pieces::Pieces;
use super::record::{Record, Row};
use crate::setup::Setup;
use dem_laboratory::figure::{Figure, Source};
use dem_laboratory::test_result::{Crack, FirstBroken, PRESSURE_OFF, STIFFNESS, TestResult};
use dem_laboratory::theory::Beam;
use dem_laboratory::theory::{
    KAPPA, PEAK_AXIAL_STRESS, bar_stress_pa, disc_modulus_pa, disc_stress_pa,
};
use dem_laboratory::{Specimen, TestType, area_between};

/// Input of the evaluation.
#[derive(Debug, Clone, Copy)]
pub struct TestInput<'a> {
    /// The test, with its rate.
    pub test: &'a Test,
    /// Arrangement of the test.
    pub setup: &'a Setup,
    /// Record of the test.
    pub record: &'a Record,
    /// Initial position of each broken bond of the record, m.
    pub places_m: &'a [[f64; 3]],
    /// Type of the body's bonds.
    pub bonds: Option<&'a BondKind>,
    /// Hz.
    pub lowest_frequency_hz: f64,
    /// See [`TestSettings::wanted_n`](crate::watch::TestSettings::wanted_n).
    pub wanted_n: Option<f64>,
    /// The load fell below half of its maximum.
    pub broken: bool,
    /// Number of all bonds.
    pub all_bonds: usize,
    /// Pieces of the body at the end. None: it cannot break.
    pub pieces: Option<Pieces>,
}

/// Evaluates a quasi-static test. Figures that cannot be determined from its record are omitted.
pub fn evaluate(evidence: &TestInput<'_>) -> TestResult {
    let TestInput {
        test,
        setup,
        record,
        ..
    } = *evidence;
    let rows = &rows_of(record, evidence.lowest_frequency_hz);
    let slope = |way: fn(&Row) -> f64| slope(rows, evidence.wanted_n, way);
    let by_travel = slope(|row| row.travel_m);
    let measured = !setup.moving.is_empty();
    let of_body = slope(|row| row.deflection_m).filter(|_| measured);
    let largest = largest_n(rows);
    let mut measured = Measured::of(
        test,
        setup,
        [by_travel, of_body].map(|slope| Some(slope?.stiffness_n_m)),
        largest.filter(|_| evidence.broken),
    );
    let play_m = play_m(rows);
    let travel = peak(rows).map(|row| row.travel_m - play_m);
    measured.add(
        TRAVEL_AT_FAILURE,
        travel.filter(|_| evidence.broken),
        "m",
        None,
    );
    if !evidence.broken {
        measured.add(LARGEST_FORCE, largest, "N", None);
    }
    (measured.figures).extend(confined::figures(test, setup, rows));
    (measured.figures).extend(disc_stress::figures(setup, &record.disc));
    let points = rows.iter().map(|row| [row.travel_m - play_m, row.load_n()]);
    let curve: Vec<[f64; 2]> = points.collect();
    let wanted = measured_curve(test, &setup.specimen);
    if !wanted.is_empty() {
        measured.add(APART, Some(area_between(&curve, &wanted)), "", None);
    }
    let first_broken = first_broken(evidence).map(|first| FirstBroken {
        travel_m: first.travel_m - play_m,
        ..first
    });
    let mut result = TestResult {
        rate_m_s: test.rate_m_s.unwrap_or(f64::NAN),
        dimensions: measured.dimensions,
        figures: measured.figures,
        first_broken,
        curve,
        reasons: second_peak(evidence, rows).into_iter().collect(),
        ..without_figures(evidence, rows)
    };
    result.calibration = calibration(&result, evidence);
    result
}

/// A sentence on a strength that is that of a second peak, as of debris between the plates.
fn second_peak(evidence: &TestInput<'_>, rows: &[Row]) -> Option<String> {
    let counts = evidence.broken && !evidence.test.kind.has_residual();
    let [before_n, low_n] = earlier_peak(rows).filter(|_| counts)?;
    let largest_n = peak(rows)?.load_n();
    let [before, low, largest] = [before_n, low_n, largest_n].map(|load| show_quantity(load, "N"));
    Some(format!(
        "the load has two peaks: it falls from {before} to {low} and rises to {largest}, which is taken as its strength, though the body may have failed at the first: see force-displacement.csv; take smaller spheres, or other packings"
    ))
}

/// What all tests have in common.
pub(super) fn without_figures(evidence: &TestInput<'_>, rows: &[Row]) -> TestResult {
    TestResult {
        kind: evidence.test.kind,
        broken: evidence.broken,
        broken_bonds: [evidence.record.broken.len(), evidence.all_bonds],
        broken_at_peak: broken_at_peak(evidence.record, rows),
        target_strength_pa: evidence.test.strength_pa,
        lowest_frequency_hz: evidence.lowest_frequency_hz,
        rate_m_s: f64::NAN,
        dimensions: Vec::new(),
        figures: Vec::new(),
        calibration: Vec::new(),
        first_broken: None,
        crack: crack(evidence),
        curve: Vec::new(),
        reasons: Vec::new(),
        half_the_rate_changes: Vec::new(),
    }
}

/// The mean curve of the measured material of a test, for the simulated specimen: displacement, m,
/// and load, N. Empty: the test names none.
pub fn measured_curve(test: &Test, specimen: &Specimen) -> Vec<[f64; 2]> {
    let measured = test.measured.as_ref();
    measured.map_or_else(Vec::new, |measured| measured.material.curve_of(specimen))
}

/// The stiffness of the measured material of a test, for the simulated specimen, N/m.
pub fn stiffness_of_curve(test: &Test, specimen: &Specimen) -> Option<f64> {
    let material = &test.measured.as_ref()?.material;
    material.stiffness_of(specimen)
}

/// Results read from the curve of a test.
struct Measured {
    /// Ratio of load to travel, N/m.
    stiffness_n_m: Option<f64>,
    /// Ratio of load to the deformation of the body itself, N/m.
    of_body_n_m: Option<f64>,
    /// Load at which the body broke, N.
    failure_n: Option<f64>,
    /// Modulus given in the scene, Pa.
    modulus_pa: Option<f64>,
    /// Strength given in the scene, Pa.
    strength_pa: Option<f64>,
    dimensions: Vec<Figure>,
    figures: Vec<Figure>,
}

/// Dimensions, stiffness and moduli of a test: `by_travel` and `of_body` are the ratios of the load
/// to the travel and to the deformation of the body, N/m.
pub(crate) fn elastic_figures(
    test: &Test,
    setup: &Setup,
    by_travel: Option<f64>,
    of_body: Option<f64>,
) -> (Vec<Figure>, Vec<Figure>) {
    let measured = Measured::of(test, setup, [by_travel, of_body], None);
    (measured.dimensions, measured.figures)
}

impl Measured {
    /// Dimensions and figures from the ratios of the load to travel and deformation, N/m, and the
    /// load at failure, N.
    fn of(
        test: &Test,
        setup: &Setup,
        [stiffness_n_m, of_body_n_m]: [Option<f64>; 2],
        failure_n: Option<f64>,
    ) -> Self {
        let mut measured = Self {
            stiffness_n_m,
            of_body_n_m,
            failure_n,
            modulus_pa: test.young_modulus_pa,
            strength_pa: test.strength_pa,
            dimensions: Vec::new(),
            figures: Vec::new(),
        };
        match setup.specimen {
            Specimen::Beam(beam) => measured.beam(&beam, test.poisson_ratio),
            Specimen::Disc {
                diameter_m,
                thickness_m,
            } => measured.disc(
                [diameter_m, thickness_m, setup.gauge_m],
                test.poisson_ratio,
                stiffness_of_curve(test, &setup.specimen),
            ),
            Specimen::Bar { length_m, area_m2 } => {
                measured.bar(test.kind, [length_m, setup.gauge_m], area_m2);
                let looked = [
                    ("section of the body", setup.section_m2, "m2"),
                    (PRESSED, setup.pressed, ""),
                ];
                for (name, value, unit) in looked {
                    if let Some(value) = value {
                        measured.dimension(name, value, unit);
                    }
                }
            }
        }
        measured.name_sources(test);
        measured
    }

    /// Says which targets were measured.
    fn name_sources(&mut self, test: &Test) {
        let Some(reference) = &test.measured else {
            return;
        };
        let material = &reference.material;
        let modulus_pa = material.young_modulus_pa.map(|modulus| modulus.mean);
        let is_disc = modulus_pa.is_none();
        let strength_is = test.strength_pa == Some(material.strength_pa.mean);
        let modulus_is = test.young_modulus_pa.is_some() && test.young_modulus_pa == modulus_pa;
        for figure in &mut self.figures {
            let is_measured = match figure.name.as_str() {
                STRENGTH | FAILURE_FORCE => strength_is,
                STIFFNESS => modulus_is || is_disc,
                _ => modulus_is,
            };
            if is_measured && figure.theory_is.is_some() {
                figure.theory_is = Some(Source::Measured);
            }
        }
    }

    fn add(&mut self, name: &str, value: Option<f64>, unit: &str, theory: Option<f64>) {
        let figure = value.map(|value| Figure::new(name, value, unit, theory));
        self.figures.extend(figure);
    }

    fn dimension(&mut self, name: &str, value: f64, unit: &str) {
        self.dimensions.push(Figure::new(name, value, unit, None));
    }

    fn beam(&mut self, beam: &Beam, nu: f64) {
        self.dimension("support span", beam.span_m, "m");
        if beam.loading_span_m > 0.0 {
            self.dimension("loading span", beam.loading_span_m, "m");
        }
        self.dimension("width", beam.width_m, "m");
        self.dimension("height", beam.height_m, "m");
        let (shape, shear) = (beam.bending_shape_m(), beam.shear_over_bending(nu, KAPPA));
        let theory = self
            .modulus_pa
            .map(|modulus| beam.stiffness_n_m(modulus, nu, KAPPA));
        self.add(STIFFNESS, self.stiffness_n_m, "N/m", theory);
        self.add(SPECIMEN_STIFFNESS, self.of_body_n_m, "N/m", theory);
        let bending = |k: f64| k / shape;
        let with_shear = |k: f64| k * (1.0 + shear) / shape;
        self.add(
            EQ_18,
            self.stiffness_n_m.map(bending),
            "Pa",
            self.modulus_pa,
        );
        self.add(
            WITH_SHEAR,
            self.stiffness_n_m.map(with_shear),
            "Pa",
            self.modulus_pa,
        );
        self.add(
            MODULUS,
            self.of_body_n_m.map(with_shear),
            "Pa",
            self.modulus_pa,
        );
        let theory = self.strength_pa.map(|strength| beam.force_n(strength));
        self.add(FAILURE_FORCE, self.failure_n, "N", theory);
        let stress = self.failure_n.map(|force| beam.stress_pa(force));
        self.add(STRENGTH, stress, "Pa", self.strength_pa);
    }

    /// Of a disc with this diameter, thickness and gauge length, m; `curve_n_m`: stiffness of the
    /// measured curve.
    fn disc(&mut self, sizes_m: [f64; 3], nu: f64, curve_n_m: Option<f64>) {
        let [diameter_m, thickness_m, gauge_m] = sizes_m;
        self.dimension("diameter", diameter_m, "m");
        self.dimension("thickness", thickness_m, "m");
        self.add(STIFFNESS, self.stiffness_n_m, "N/m", curve_n_m);
        if gauge_m > 0.0 {
            self.dimension("gauge length", gauge_m, "m");
            // The measured points approach each other.
            let of_gauge = |k: f64| disc_modulus_pa(k.abs(), diameter_m, thickness_m, gauge_m, nu);
            self.add(
                MODULUS,
                self.of_body_n_m.map(of_gauge),
                "Pa",
                self.modulus_pa,
            );
        }
        let stress = |force: f64| disc_stress_pa(force, diameter_m, thickness_m);
        let theory = self.strength_pa.map(|strength| strength / stress(1.0));
        self.add(FAILURE_FORCE, self.failure_n, "N", theory);
        self.add(STRENGTH, self.failure_n.map(stress), "Pa", self.strength_pa);
    }

    /// Of a bar, the neck of a dog bone or a sheared body with this length and gauge length, m.
    fn bar(&mut self, kind: TestType, [length_m, gauge_m]: [f64; 2], area_m2: f64) {
        self.dimension("length", length_m, "m");
        self.dimension("area", area_m2, "m2");
        if kind != TestType::DirectShear {
            self.dimension("gauge length", gauge_m, "m");
        }
        // The wide ends of a dog bone and the halves of a sheared body yield as well.
        if matches!(kind, TestType::DogBone | TestType::DirectShear) {
            self.add(STIFFNESS, self.stiffness_n_m, "N/m", None);
        } else {
            let theory = self.modulus_pa.map(|modulus| modulus * area_m2 / length_m);
            self.add(STIFFNESS, self.stiffness_n_m, "N/m", theory);
            let of_length = |k: f64| k * length_m / area_m2;
            let by_travel_pa = self.stiffness_n_m.map(of_length);
            self.add(BY_TRAVEL, by_travel_pa, "Pa", self.modulus_pa);
        }
        let theory = self.modulus_pa.map(|modulus| modulus * area_m2 / gauge_m);
        // In compression, the measured points approach each other.
        let of_body = self.of_body_n_m.map(f64::abs);
        self.add(SPECIMEN_STIFFNESS, of_body, "N/m", theory);
        let of_gauge = |k: f64| k * gauge_m / area_m2;
        self.add(MODULUS, of_body.map(of_gauge), "Pa", self.modulus_pa);
        let stress = |force: f64| bar_stress_pa(force, area_m2);
        let theory = self.strength_pa.map(|strength| strength * area_m2);
        self.add(FAILURE_FORCE, self.failure_n, "N", theory);
        self.add(STRENGTH, self.failure_n.map(stress), "Pa", self.strength_pa);
    }
}

/// The smaller part of the two ends of a body that plates press.
const PRESSED: &str = "pressed part of its ends";
/// Modulus of a beam from the travel, without shear: Platzer 2022, eq. 18.
pub const EQ_18: &str = "modulus without shear";
/// Ratio of load to the specimen's own deflection or elongation.
const SPECIMEN_STIFFNESS: &str = "specimen stiffness";
/// The same as eq. 18, with shear.
const WITH_SHEAR: &str = "modulus with shear";
/// Travel at the largest load of a body that broke.
const TRAVEL_AT_FAILURE: &str = "crosshead travel at failure";
/// Modulus of a bar from the travel.
pub const BY_TRAVEL: &str = "modulus by travel";
/// Modulus of the body from its own deflection or elongation, including shear.
pub const MODULUS: &str = dem_laboratory::test_result::MODULUS;
/// Largest load before the body broke.
pub const FAILURE_FORCE: &str = "failure force";
/// Largest load of a body that did not break.
pub const LARGEST_FORCE: &str = dem_laboratory::test_result::LARGEST_FORCE;
/// Area between the measured and the simulated curve, over the area below the measured one.
const APART: &str = "area between the curves";
/// Stress at that force according to the formula of the test.
pub const STRENGTH: &str = dem_laboratory::test_result::STRENGTH;

/// Names and dimensions of all results of quasi-static tests; each test has some of them.
pub(crate) const RESULTS: [(&str, &Dimension); 18] = [
    (STIFFNESS, &units::STIFFNESS),
    (SPECIMEN_STIFFNESS, &units::STIFFNESS),
    (EQ_18, &units::STRESS),
    (WITH_SHEAR, &units::STRESS),
    (BY_TRAVEL, &units::STRESS),
    (MODULUS, &units::STRESS),
    (FAILURE_FORCE, &units::FORCE),
    (LARGEST_FORCE, &units::FORCE),
    (STRENGTH, &units::STRESS),
    (TRAVEL_AT_FAILURE, &units::LENGTH),
    (APART, &units::NUMBER),
    (POISSON_RATIO, &units::NUMBER),
    (PEAK_AXIAL_STRESS, &units::STRESS),
    (RESIDUAL, &units::STRESS),
    (RESIDUAL_FRICTION, &units::NUMBER),
    (PRESSURE_OFF, &units::NUMBER),
    (ACROSS, &units::STRESS),
    (ALONG, &units::STRESS),
];

/// Required bond parameters. Stresses and strains are proportional to modulus and strength of the
/// bonds: one run gives the factor.
fn calibration(result: &TestResult, evidence: &TestInput<'_>) -> Vec<Figure> {
    let mut found = Vec::new();
    let Some(bonds) = evidence.bonds else {
        return found;
    };
    let test = evidence.test;
    if let Some(modulus) = result.figure(MODULUS) {
        let factor = modulus / bonds.young_modulus_pa;
        found.push(Figure::new(
            "specimen modulus over bond modulus",
            factor,
            "",
            None,
        ));
        if let Some(wanted) = test.young_modulus_pa {
            let name = "bond modulus for the target";
            found.push(Figure::new(name, wanted / factor, "Pa", None));
        }
    }
    // As in Platzer 2022, section 4.5.3.3, including all compliance at the pins.
    if let (Some(modulus), Some(wanted)) = (result.figure(EQ_18), test.young_modulus_pa) {
        let name = "bond modulus by eq. 18";
        let value = wanted / modulus * bonds.young_modulus_pa;
        found.push(Figure::new(name, value, "Pa", None));
    }
    let failure = &bonds.failure;
    let of_bonds = failure
        .von_mises_strength_pa
        .or(failure.tensile_strength_pa);
    let of_bonds = of_bonds.or(failure.compressive_strength_pa);
    let of_bonds = of_bonds.filter(|strength| *strength > 0.0);
    if let (Some(strength), Some(of_bonds)) = (result.figure(STRENGTH), of_bonds) {
        let factor = strength / of_bonds;
        found.push(Figure::new(
            "specimen strength over bond strength",
            factor,
            "",
            None,
        ));
        if let Some(wanted) = test.strength_pa {
            let name = "bond strength for the target";
            found.push(Figure::new(name, wanted / factor, "Pa", None));
        }
    }
    found
}

/// Number of bonds that broke before the largest load.
fn broken_at_peak(record: &Record, rows: &[Row]) -> usize {
    let time_s = peak(rows).map_or(0.0, |row| row.time_s);
    record
        .broken
        .partition_point(|broken| broken.time_s <= time_s)
}

pub(super) fn first_broken(evidence: &TestInput<'_>) -> Option<FirstBroken> {
    let first = evidence.record.broken.first()?;
    let rows = &evidence.record.rows;
    // The last row before it: the next one may already include the fall.
    let before = rows.partition_point(|row| row.time_s <= first.time_s);
    let nearest = rows.get(before.saturating_sub(1))?;
    Some(FirstBroken {
        time_s: first.time_s,
        // The anvil feels the impact of a weight later.
        force_n: match evidence.test.weight {
            Some(_) => nearest.force_n,
            None => nearest.load_n(),
        },
        travel_m: nearest.travel_m,
        place_m: *evidence.places_m.first()?,
        cause: first.cause,
    })
}

fn crack(evidence: &TestInput<'_>) -> Option<Crack> {
    let setup = evidence.setup;
    let offset = |place: &[f64; 3]| -> f64 {
        (0..3)
            .map(|k| (place[k] - setup.middle_m[k]) * setup.along[k])
            .sum()
    };
    let offsets: Vec<f64> = evidence.places_m.iter().map(offset).collect();
    let count = offsets.len() as f64;
    if offsets.is_empty() {
        return None;
    }
    let mean = offsets.iter().sum::<f64>() / count;
    let variance = offsets.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / count;
    let within_m = setup.crack_within_m;
    let within = offsets.iter().filter(|x| x.abs() <= within_m).count();
    Some(Crack {
        bonds: offsets.len(),
        offset_m: mean,
        spread_m: variance.sqrt(),
        within_m,
        is_within: mean.abs() <= within_m,
        fraction_within: within as f64 / count,
    })
}
