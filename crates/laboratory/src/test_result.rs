//! The result of a laboratory test as data: its figures, the first broken bond, the crack.

mod answer;
mod text;

use dem_physics::bond::failure::Cause;
use serde::{Deserialize, Serialize};

use crate::figure::{Figure, Source};
use crate::specimen::TestType;

/// Names of figures that are looked up: ratio of load to travel.
pub const STIFFNESS: &str = "stiffness";
/// Of the body alone, without its contacts.
pub const MODULUS: &str = "specimen modulus";
/// Largest stress of a body that broke.
pub const STRENGTH: &str = "strength";
/// Largest load on a body that did not break, or of a weight.
pub const LARGEST_FORCE: &str = "largest force";
/// Share of the mass of the largest fragment.
pub const LARGEST_FRAGMENT: &str = "largest fragment";
/// Largest deviation of a lateral pressure from the one wanted, up to the largest load.
pub const PRESSURE_OFF: &str = "deviation of the lateral pressure";
/// Rate of strain while the load rises, 1/s.
pub const STRAIN_RATE: &str = "strain rate";
/// Strength over the static one.
pub const INCREASE_FACTOR: &str = "dynamic increase factor";
/// Largest difference of the forces on both ends between half of the largest load and all of it,
/// over the largest load.
pub const EQUILIBRIUM: &str = "force equilibrium";
/// Share of the incident energy that the pulses and the work of the bars disagree by.
pub const UNBOOKED: &str = "energy unaccounted for";
/// Share of the mass finer than a tenth of the body's size.
pub const T10: &str = "t10";
/// Share of the mass of the spheres that are smaller than that: t10 cannot be larger.
pub const LARGEST_T10: &str = "largest possible t10";

/// The first bond that broke.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FirstBroken {
    /// Time, s.
    pub time_s: f64,
    /// Load at that time, N.
    pub force_n: f64,
    /// Crosshead travel at that time, from the point where the fitted line has no load, m.
    pub travel_m: f64,
    /// Initial position in the body, m. Length 3.
    pub place_m: [f64; 3],
    /// Cause of failure.
    pub cause: Cause,
}

/// Position of the broken bonds in the initial body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Crack {
    /// Number of broken bonds.
    pub bonds: usize,
    /// Mean distance from the middle of the span, of a bar's length or of the loaded diameter, m.
    pub offset_m: f64,
    /// Standard deviation of that, m.
    pub spread_m: f64,
    /// The crack is in the expected place if `offset_m` does not exceed this, m: half the loading
    /// span of a four-point test.
    pub within_m: f64,
    /// Whether the crack is in the expected place.
    pub is_within: bool,
    /// Fraction of the broken bonds that are individually in the expected place.
    pub fraction_within: f64,
}

/// Result of a test.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TestResult {
    /// Its type, as in the scene.
    #[serde(rename = "type")]
    pub kind: TestType,
    /// Whether the body broke: the load fell below half of its maximum.
    pub broken: bool,
    /// Number of broken bonds, and of all bonds.
    pub broken_bonds: [usize; 2],
    /// Number of bonds that broke before the largest load.
    pub broken_at_peak: usize,
    /// Strength given in the scene, Pa.
    pub target_strength_pa: Option<f64>,
    /// Lowest frequency of the body in the test, estimated, Hz.
    pub lowest_frequency_hz: f64,
    /// Crosshead velocity, that of the striker, or that of the weight at the impact, m/s.
    pub rate_m_s: f64,
    /// Dimensions used in the evaluation.
    pub dimensions: Vec<Figure>,
    /// Results.
    #[serde(rename = "results")]
    pub figures: Vec<Figure>,
    /// Bond parameters with which the body would have the modulus and the strength given in the
    /// scene.
    pub calibration: Vec<Figure>,
    /// None: no bond broke.
    pub first_broken: Option<FirstBroken>,
    /// None: no bond broke.
    pub crack: Option<Crack>,
    /// Displacement, m, from where the fitted line has no load, and load, N.
    #[serde(skip)]
    pub curve: Vec<[f64; 2]>,
    /// Reasons to doubt the test that its figures do not show.
    #[serde(skip)]
    pub reasons: Vec<String>,
    /// Relative changes of the figures at half the rate: (slow - fast)/fast. Empty: not checked.
    #[serde(rename = "changes_at_half_the_rate")]
    pub half_the_rate_changes: Vec<Figure>,
}

impl TestResult {
    /// Whether the test was dynamic.
    pub fn is_dynamic(&self) -> bool {
        self.kind.is_dynamic()
    }

    /// The value of a figure.
    pub fn figure(&self, name: &str) -> Option<f64> {
        let found = self.figures.iter().find(|figure| figure.name == name);
        found.map(|figure| figure.value)
    }

    /// Records the relative differences of its figures from those of the same test at twice the
    /// rate. A figure with a closed form is compared over it, as the stress of a disc is that at
    /// the last load that was looked at before a bond broke, which differs by up to a tenth.
    pub fn compare(&mut self, fast: &Self) {
        let theory = |figure: &Figure| {
            let is_closed = figure.theory_is == Some(Source::ClosedForm);
            figure.theory.filter(|_| is_closed)
        };
        let compared = |figure: &Figure| {
            let other = fast.figures.iter().find(|one| one.name == figure.name)?;
            let [slow, before] = match (theory(figure), theory(other)) {
                (Some(own), Some(others)) => [figure.value / own.abs(), other.value / others.abs()],
                _ => [figure.value, other.value],
            };
            let change = (slow - before) / before.abs();
            change
                .is_finite()
                .then(|| Figure::new(&figure.name, change, "", None))
        };
        self.half_the_rate_changes = self.figures.iter().filter_map(compared).collect();
    }
}
