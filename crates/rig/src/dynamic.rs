//! Results of dynamic tests: of a specimen between two long bars, and of a body under a falling
//! weight.
//!
//! Bars: with the impedance Z = rho c A of a bar, the force F_1 of the incident bar on the specimen
//! and that of the specimen on the transmission bar, F_2, the strains in compression (in a tension
//! test, in tension) at the ends of the bars are eps_I = v_I/c, eps_R = F_1/(Z c) - eps_I and
//! eps_T = F_2/(Z c). Source: Kolsky 1949; the specimen is in equilibrium if eps_I + eps_R = eps_T.

use std::ops::RangeInclusive;

use dem_io::units::{self, Dimension, significant};
use dem_laboratory::{Specimen, TestType};
use dem_scene::{Bars, Gauges, Weight};

use super::curve::rows_of;
use super::evaluate::{
    FAILURE_FORCE, LARGEST_FORCE, RESULTS, STRENGTH, TestInput, first_broken, without_figures,
};
use super::record::{Record, Row};
use dem_engine::state::loads::factor_at;
use dem_laboratory::figure::{Figure, Source};
use dem_laboratory::test_result::{
    EQUILIBRIUM, INCREASE_FACTOR, LARGEST_FRAGMENT, LARGEST_T10, STRAIN_RATE, T10, TestResult,
    UNBOOKED,
};
use dem_physics::bond::strain_rate::{HIGHEST_1_S, dynamic_increase_factor};

/// Fraction of the largest load from which on the body counts as loaded.
const LOADED: f64 = 0.1;
/// Fractions of the largest load between which the rates are means.
const RISE: [f64; 2] = [LOADED, 0.9];
/// Fraction of the largest load from which on the forces on both ends have to agree.
const AGREES: f64 = 0.5;
/// Sections of the bars, over that of the body, for which a bar stands for a rigid end.
const SECTIONS: RangeInclusive<f64> = 0.99..=100.0;
/// Fraction of the largest load above which a run ends too early.
const STILL_LOADED: f64 = 0.5;
/// Fraction of the pulse before whose end a run is cut short.
const CUT_SHORT: f64 = 0.99;
/// Fraction of the largest load at which a contact of the weight begins and ends.
const TOUCHES: f64 = 0.01;
/// Energy in J/kg of one kWh/t.
const J_KG_PER_KWH_T: f64 = 3600.0;

/// Largest stress, Pa, of a body that did not break.
pub const LARGEST_STRESS: &str = "largest stress";

/// Names and dimensions of the results of dynamic tests that a body can be calibrated to; each test
/// has some of them.
const DYNAMIC_RESULTS: [(&str, &Dimension); 12] = [
    (STRENGTH, &units::STRESS),
    (FAILURE_FORCE, &units::FORCE),
    (LARGEST_FORCE, &units::FORCE),
    (LARGEST_STRESS, &units::STRESS),
    (STRAIN_RATE, &units::RATE),
    (INCREASE_FACTOR, &units::NUMBER),
    ("contact duration", &units::TIME),
    ("absorbed energy", &units::ENERGY),
    ("specific absorbed energy", &units::ENERGY_PER_MASS),
    ("rebound velocity", &units::VELOCITY),
    (LARGEST_FRAGMENT, &units::NUMBER),
    (T10, &units::NUMBER),
];

/// Names and dimensions of the results that a test of this type can have.
pub fn results_of(kind: TestType) -> &'static [(&'static str, &'static Dimension)] {
    if kind.is_dynamic() {
        &DYNAMIC_RESULTS
    } else {
        &RESULTS
    }
}

/// Evaluates a dynamic test: its figures are those of its bars or its weight, and its travel has no
/// play.
pub fn evaluate_dynamic(evidence: &TestInput<'_>) -> TestResult {
    let rows = &rows_of(evidence.record, evidence.lowest_frequency_hz);
    let found = figures(evidence, rows);
    let points = rows.iter().map(|row| [row.travel_m, row.load_n()]);
    TestResult {
        rate_m_s: found.rate_m_s,
        dimensions: found.dimensions,
        figures: found.figures,
        reasons: found.reasons,
        first_broken: first_broken(evidence),
        curve: points.collect(),
        ..without_figures(evidence, rows)
    }
}

/// Dimensions and figures of a dynamic test.
#[derive(Debug, Clone, Default, PartialEq)]
struct Found {
    /// Velocity of the striker or of the weight, m/s.
    rate_m_s: f64,
    dimensions: Vec<Figure>,
    figures: Vec<Figure>,
    /// Reasons to doubt the test.
    reasons: Vec<String>,
}

impl Found {
    fn dimension(&mut self, name: &str, value: f64, unit: &str) {
        self.dimensions.push(Figure::new(name, value, unit, None));
    }

    fn add(&mut self, name: &str, value: Option<f64>, unit: &str) {
        self.compare(name, value, unit, None);
    }

    fn compare(&mut self, name: &str, value: Option<f64>, unit: &str, theory: Option<f64>) {
        let value = value.filter(|value| value.is_finite());
        self.figures.extend(
            value.map(|value| Figure::new(name, value, unit, theory).by(Source::ClosedForm)),
        );
    }
}

/// Dimensions and figures of a test with bars or a weight; `rows` are means over a part of the
/// body's lowest period.
fn figures(evidence: &TestInput<'_>, rows: &[Row]) -> Found {
    let mut found = Found::default();
    match (&evidence.test.bars, &evidence.test.weight) {
        (Some(bars), _) => of_bars(&mut found, evidence, bars, rows),
        (_, Some(weight)) => of_weight(&mut found, evidence, weight),
        _ => {}
    }
    found
}

fn of_bars(found: &mut Found, evidence: &TestInput<'_>, bars: &Bars, rows: &[Row]) {
    found.rate_m_s = bars.striker_m_s;
    let specimen = evidence.setup.specimen;
    let (length_m, area_m2) = match specimen {
        Specimen::Disc {
            diameter_m,
            thickness_m,
        } => {
            found.dimension("diameter", diameter_m, "m");
            found.dimension("thickness", thickness_m, "m");
            (diameter_m, diameter_m * thickness_m)
        }
        Specimen::Bar { length_m, area_m2 } => {
            found.dimension("length", length_m, "m");
            found.dimension("area", area_m2, "m2");
            (length_m, area_m2)
        }
        Specimen::Beam(_) => return,
    };
    let sections = bars.area_m2() / area_m2;
    if !SECTIONS.contains(&sections) {
        found.reasons.push(format!(
            "the section of the bars is {} times that of the body ({} to {}): check test.bars.diameter",
            significant(sections, 3),
            SECTIONS.start(),
            SECTIONS.end()
        ));
    }
    found.dimension("bar wave speed", bars.wave_speed_m_s(), "m/s");
    found.dimension("bar impedance", bars.impedance_n_s_m(), "N s/m");
    found.dimension("pulse duration", bars.pulse_s(), "s");
    found.dimension(
        "incident strain",
        bars.incident_m_s() / bars.wave_speed_m_s(),
        "",
    );
    let curve = stress_strain(rows, &specimen, length_m);
    // The load while the pulse lasts: later waves are not part of the test.
    let during = rows.partition_point(|row| row.time_s <= bars.pulse_end_s());
    let peak = (0..during).max_by(|a, b| rows[*a].load_n().total_cmp(&rows[*b].load_n()));
    if let (Some(peak), Some(last)) = (peak, rows.last())
        && last.time_s < CUT_SHORT * bars.pulse_end_s()
        && last.load_n() > STILL_LOADED * rows[peak].load_n()
    {
        found.reasons.push(
            "the run ended before the pulse, and under more than half of the largest load: set a later run.end_time, or none"
                .to_owned(),
        );
    }
    if let Some(peak) = peak {
        at_peak(
            found,
            evidence,
            Peak {
                rows,
                curve: &curve,
                at: peak,
            },
        );
    }
    let signals = bar_signals(evidence.record, bars);
    let largest = |of: fn(&BarSignal) -> f64| of_largest_size(signals.iter().map(of));
    found.add("reflected strain", largest(|signal| signal.reflected), "");
    found.add(
        "transmitted strain",
        largest(|signal| signal.transmitted),
        "",
    );
    let works = &evidence.record.works;
    let carried_j = works.incident_j - works.reflected_j - works.transmitted_j;
    let done_j = works.moving_j - works.resting_j;
    found.add("incident energy", Some(works.incident_j), "J");
    found.add("reflected energy", Some(works.reflected_j), "J");
    found.add("transmitted energy", Some(works.transmitted_j), "J");
    found.add("absorbed energy", Some(done_j), "J");
    found.add(UNBOOKED, Some((carried_j - done_j) / works.incident_j), "");
}

fn of_largest_size(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.max_by(|a, b| a.abs().total_cmp(&b.abs()))
}

/// The largest load of a test with bars.
#[derive(Clone, Copy)]
struct Peak<'a> {
    rows: &'a [Row],
    /// Strain and stress, Pa, of each row.
    curve: &'a [[f64; 2]],
    /// Number of the row.
    at: usize,
}

impl Peak<'_> {
    /// The first row that reaches this share of the largest load.
    fn reaches(&self, share: f64) -> Option<usize> {
        let largest_n = self.rows[self.at].load_n();
        let mut before = self.rows[..=self.at].iter();
        before.position(|row| row.load_n() >= share * largest_n)
    }

    /// Largest difference of the forces on both ends, over the largest load, while they have to
    /// agree.
    fn apart(&self) -> Option<f64> {
        let largest_n = self.rows[self.at].load_n();
        let rows = &self.rows[self.reaches(AGREES)?..=self.at];
        let differences = rows.iter().map(|row| row.force_n - row.reaction_n);
        of_largest_size(differences).map(|difference_n| difference_n / largest_n)
    }

    /// Rates, 1/s, of strain and of stress, Pa/s, while the load rises.
    fn rates(&self) -> Option<[f64; 2]> {
        let [from, to] = [self.reaches(RISE[0])?, self.reaches(RISE[1])?];
        let during_s = self.rows[to].time_s - self.rows[from].time_s;
        let gain = |k: usize| (self.curve[to][k] - self.curve[from][k]) / during_s;
        (during_s > 0.0).then(|| [gain(0), gain(1)])
    }
}

/// Figures at the largest load.
fn at_peak(found: &mut Found, evidence: &TestInput<'_>, peak: Peak<'_>) {
    let test = evidence.test;
    let row = &peak.rows[peak.at];
    let [strain, stress_pa] = peak.curve[peak.at];
    let (force, stress) = if evidence.broken {
        (FAILURE_FORCE, STRENGTH)
    } else {
        (LARGEST_FORCE, LARGEST_STRESS)
    };
    let rates = peak.rates();
    let strain_rate = match (&evidence.setup.specimen, test.young_modulus_pa) {
        // In the middle of a disc, the rate of the tensile stress over the modulus.
        (Specimen::Disc { .. }, modulus_pa) => rates
            .zip(modulus_pa)
            .map(|([_, stress], modulus)| stress / modulus),
        _ => rates.map(|[strain, _]| strain),
    };
    found.add(force, Some(row.load_n()), "N");
    found.add(stress, Some(stress_pa), "Pa");
    found.add("loading rate", rates.map(|[_, stress]| stress), "Pa/s");
    found.add(STRAIN_RATE, strain_rate, "1/s");
    if matches!(evidence.setup.specimen, Specimen::Bar { .. }) {
        found.add("strain at the largest load", Some(strain), "");
    }
    found.add(EQUILIBRIUM, peak.apart(), "");
    if let (true, Some(strength_pa)) = (evidence.broken, test.strength_pa) {
        // The printed fit ends at 50/s.
        let known = strain_rate.filter(|rate| *rate > 0.0 && *rate <= HIGHEST_1_S);
        let theory = known.map(|rate| dynamic_increase_factor(rate, 0.0));
        let factor = stress_pa / strength_pa;
        found.compare(INCREASE_FACTOR, Some(factor), "", theory);
    }
}

/// Strain, shortening or elongation from the motion of the bars' ends over the length of the
/// specimen (of a disc, over its diameter), and stress, Pa, for each row.
pub(super) fn stress_strain(rows: &[Row], specimen: &Specimen, length_m: f64) -> Vec<[f64; 2]> {
    let mut curve: Vec<[f64; 2]> = Vec::with_capacity(rows.len());
    let (mut strain, mut before_s, mut before_1_s) = (0.0, 0.0, 0.0);
    for row in rows {
        let [moving_m_s, resting_m_s, _] = row.speeds_m_s;
        let rate_1_s = (moving_m_s - resting_m_s) / length_m;
        strain += 0.5 * (before_1_s + rate_1_s) * (row.time_s - before_s);
        (before_s, before_1_s) = (row.time_s, rate_1_s);
        curve.push([strain, specimen.stress_pa(row.load_n())]);
    }
    curve
}

/// Strains at the ends of the bars.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct BarSignal {
    /// s.
    pub time_s: f64,
    /// Of the incident pulse; positive in compression, or in tension if the test pulls.
    pub incident: f64,
    /// Of the reflected pulse.
    pub reflected: f64,
    /// Of the transmitted pulse.
    pub transmitted: f64,
}

/// The pulses that strain gauges would record, moved to the ends of the bars.
pub fn bar_signals(record: &Record, bars: &Bars) -> Vec<BarSignal> {
    let c_m_s = bars.wave_speed_m_s();
    let strain = |force_n: f64| force_n / (bars.impedance_n_s_m() * c_m_s);
    let signal = |row: &Row| {
        let incident = row.speeds_m_s[2] / c_m_s;
        BarSignal {
            time_s: row.time_s,
            incident,
            reflected: strain(row.force_n) - incident,
            transmitted: strain(row.reaction_n),
        }
    };
    record.rows.iter().map(signal).collect()
}

/// What the strain gauges on both bars record at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaugeSignal {
    /// s; the incident pulse arrives at the body at 0.
    pub time_s: f64,
    /// Strain of the incident bar: the incident and the reflected pulse.
    pub incident_bar: f64,
    /// Strain of the transmission bar: the transmitted pulse.
    pub transmission_bar: f64,
}

/// The record of strain gauges at a distance d from the ends of the bars, where the strains are
/// f(t) and g(t) in the incident bar and h(t) in the other: f(t + d/c) + g(t - d/c) and
/// h(t - d/c), d'Alembert's waves. It goes from the time at which the pulse arrives at the gauge,
/// -d/c, to the time at which the end of the run does.
pub fn gauge_signals(record: &Record, bars: &Bars, gauges: Gauges) -> Vec<GaugeSignal> {
    let pulses = bar_signals(record, bars);
    let Some(last) = pulses.last() else {
        return Vec::new();
    };
    let way_s = gauges.distance_m / bars.wave_speed_m_s();
    let (from_s, to_s) = (-way_s, last.time_s + way_s);
    let rows_per_s = pulses.len() as f64 / last.time_s;
    let intervals = ((to_s - from_s) * rows_per_s).ceil() as usize;
    let incident = |time_s: f64| {
        let speed_m_s = bars.incident_m_s() * factor_at(&bars.pulse(), time_s);
        speed_m_s / bars.wave_speed_m_s()
    };
    let signal = |i: usize| {
        let time_s = from_s + (to_s - from_s) * i as f64 / intervals as f64;
        let [reflected, transmitted] = outgoing(&pulses, time_s - way_s);
        GaugeSignal {
            time_s,
            incident_bar: incident(time_s + way_s) + reflected,
            transmission_bar: transmitted,
        }
    };
    (0..=intervals).map(signal).collect()
}

/// Strains of the reflected and the transmitted pulse at the ends of the bars, straight between the
/// rows and 0 before the incident pulse arrives.
fn outgoing(pulses: &[BarSignal], time_s: f64) -> [f64; 2] {
    let after = pulses.partition_point(|pulse| pulse.time_s <= time_s);
    let before = match (time_s > 0.0, after) {
        (false, _) => return [0.0; 2],
        (true, 0) => BarSignal::default(),
        (true, after) => pulses[after - 1],
    };
    let Some(next) = pulses.get(after) else {
        return [before.reflected, before.transmitted];
    };
    let share = (time_s - before.time_s) / (next.time_s - before.time_s);
    let between = |a: f64, b: f64| a + share * (b - a);
    [
        between(before.reflected, next.reflected),
        between(before.transmitted, next.transmitted),
    ]
}

/// How long the weight presses without a break around its largest force, s. None: it never does.
fn contact_s(rows: &[Row], largest_n: f64) -> Option<f64> {
    let presses = |row: &Row| row.force_n > TOUCHES * largest_n;
    let largest = rows.iter().position(|row| row.force_n >= largest_n);
    let largest = largest.filter(|_| largest_n > 0.0)?;
    let first = rows[..largest].iter().rposition(|row| !presses(row));
    let last = rows[largest..].iter().position(|row| !presses(row));
    let first = first.map_or(0, |before| before + 1);
    let last = last.map_or(rows.len(), |behind| largest + behind) - 1;
    Some(rows[last].time_s - rows[first].time_s)
}

/// Reasons to doubt a test with a weight; the largest forces of the weight and of the anvil, N.
fn weight_reasons(rows: &[Row], largest_n: f64, anvil_n: f64) -> Vec<String> {
    if largest_n <= 0.0 {
        let said = "the weight did not touch the body: put the wall of test.crosshead at its top";
        return vec![said.to_owned()];
    }
    let mut reasons = Vec::new();
    if anvil_n < TOUCHES * largest_n {
        reasons
            .push("no wall or support behind the body took a load: put an anvil there".to_owned());
    }
    if rows
        .last()
        .is_some_and(|row| row.force_n > STILL_LOADED * largest_n)
    {
        reasons.push(
            "the run ended while the weight pressed with more than half of its largest force: set a later run.end_time, or none"
                .to_owned(),
        );
    }
    reasons
}

fn of_weight(found: &mut Found, evidence: &TestInput<'_>, weight: &Weight) {
    found.rate_m_s = weight.velocity_m_s;
    found.dimension("weight", weight.mass_kg, "kg");
    found.dimension("impact velocity", weight.velocity_m_s, "m/s");
    if let Some(pieces) = &evidence.pieces {
        found.dimension("mass of the body", pieces.mass_kg, "kg");
    }
    let rows = &evidence.record.rows;
    let largest_n = rows.iter().map(|row| row.force_n).fold(0.0, f64::max);
    let anvil_n = rows.iter().map(|row| row.reaction_n).fold(0.0, f64::max);
    found
        .reasons
        .extend(weight_reasons(rows, largest_n, anvil_n));
    let impact_j = 0.5 * weight.mass_kg * weight.velocity_m_s.powi(2);
    let end = rows.last();
    let left_j = end.map(|row| {
        let speed_m_s = row.speeds_m_s[0];
        let fall_j = weight.mass_kg * weight.gravity_m_s2 * row.travel_m;
        0.5 * weight.mass_kg * speed_m_s * speed_m_s - fall_j
    });
    found.add(LARGEST_FORCE, Some(largest_n), "N");
    found.add("largest force on the anvil", Some(anvil_n), "N");
    found.add("contact duration", contact_s(rows, largest_n), "s");
    found.add("impact energy", Some(impact_j), "J");
    let absorbed_j = evidence.record.works.moving_j;
    found.add("absorbed energy", Some(absorbed_j), "J");
    let unbooked = left_j.map(|left_j| (impact_j - left_j - absorbed_j) / impact_j);
    found.add(UNBOOKED, unbooked, "");
    let speed = end.map(|row| row.speeds_m_s[0]);
    found.add(
        "rebound velocity",
        speed.map(|speed| -speed).filter(|v| *v > 0.0),
        "m/s",
    );
    if let Some(pieces) = &evidence.pieces {
        let specific = impact_j / pieces.mass_kg;
        found.add("specific energy", Some(specific), "J/kg");
        found.add(
            "specific energy per tonne",
            Some(specific / J_KG_PER_KWH_T),
            "kWh/t",
        );
        let absorbed = absorbed_j / pieces.mass_kg;
        found.add("specific absorbed energy", Some(absorbed), "J/kg");
        found.add(
            LARGEST_FRAGMENT,
            Some(pieces.largest_kg / pieces.mass_kg),
            "",
        );
        found.add("d50", Some(pieces.sizes.d50_m), "m");
        found.add(T10, pieces.sizes.t10, "");
        found.add(LARGEST_T10, Some(pieces.largest_t10), "");
    }
}
