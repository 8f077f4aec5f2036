//! Human-readable text on a test.

use dem_io::units::{show_quantity, significant};

use super::{Crack, EQUILIBRIUM, LARGEST_T10, PRESSURE_OFF, STIFFNESS, T10, TestResult, UNBOOKED};
use crate::figure::{Figure, Source};
use crate::specimen::TestType;

/// Smallest change at half the rate that is reported.
const MUCH: f64 = 0.02;
/// Largest difference of the forces on both ends of a specimen over the largest load, between half
/// of that load and all of it, at which it counts as in equilibrium.
const APART: f64 = 0.1;
/// Share of the largest possible t10 above which the size of the spheres decides it.
const NEAR_CEILING: f64 = 0.5;
/// Largest deviation of a lateral pressure that counts as constant.
const UNSTEADY: f64 = 0.01;
/// Share of the broken bonds outside the neck of a dog bone, or the middle half of a bar between
/// two grips, above which it failed there.
const MOSTLY: f64 = 0.5;

impl TestResult {
    /// Reasons to doubt the test. Empty: none.
    pub fn doubts(&self) -> Vec<String> {
        if self.is_dynamic() {
            return self.dynamic_doubts();
        }
        let mut doubts = self.reasons.clone();
        if self.target_strength_pa.is_some() && !self.broken {
            let although = match self.broken_share() {
                0.0 => "; no bond broke".to_owned(),
                fraction => format!(
                    ", although {} % of the bonds are broken",
                    significant(100.0 * fraction, 2)
                ),
            };
            doubts.push(format!(
                "the load did not fall to half of its largest within the stroke, so there is no strength{although}: take a longer stroke (test.stroke)"
            ));
        }
        if self.figure(STIFFNESS).is_none_or(|found| found <= 0.0) {
            doubts.push(
                "the stiffness could not be determined, as the load did not rise steadily: see force-displacement.csv"
                    .to_owned(),
            );
        }
        doubts.extend(self.misplaced_crack());
        doubts.extend(self.doubts_of_pressure());
        for figure in &self.half_the_rate_changes {
            if figure.value.abs() > MUCH {
                doubts.push(format!(
                    "half the rate changes {} by {}: take more periods (test.periods)",
                    figure.name,
                    percent(figure.value)
                ));
            }
        }
        doubts
    }

    /// Whether most of the crack, or its middle, is elsewhere than the test requires. None: this
    /// type of test requires no place.
    pub(super) fn is_misplaced(&self, crack: &Crack) -> Option<bool> {
        match self.kind {
            TestType::DogBone | TestType::HopkinsonTension => {
                Some(1.0 - crack.fraction_within > MOSTLY)
            }
            _ => (!self.is_dynamic()).then_some(!crack.is_within),
        }
    }

    /// A crack elsewhere than where the test requires it.
    fn misplaced_crack(&self) -> Option<String> {
        let crack = self.crack.as_ref()?;
        if self.is_misplaced(crack) != Some(true) {
            return None;
        }
        let outside = 100.0 * (1.0 - crack.fraction_within);
        Some(match self.kind {
            TestType::DogBone => format!(
                "the body fails outside the neck, as {outside:.0} % of the broken bonds do: the test does not give the strength of the material; hold more of its ends (the groups in test.crosshead and [supports]), or make the neck narrower"
            ),
            TestType::HopkinsonTension => format!(
                "the body breaks at a grip, as {outside:.0} % of the broken bonds do not lie in its middle half, or in its neck: the test does not give the strength of the material; take a body with a neck, and write length and area of the neck (test.length, test.area)"
            ),
            _ => "the crack is outside the region that the test requires".to_owned(),
        })
    }

    /// A test under pressure without a peak, and a pressure that was not kept.
    fn doubts_of_pressure(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        let has_residual = self.kind.has_residual();
        if has_residual && !self.broken && self.target_strength_pa.is_none() {
            doubts.push(
                "the stress did not fall below 95 % of its largest by the end of the stroke, so there is no strength: take a longer stroke (test.stroke)"
                    .to_owned(),
            );
        }
        let off = self.figure(PRESSURE_OFF).unwrap_or(0.0);
        if off > UNSTEADY {
            doubts.push(format!(
                "the lateral pressure deviated by up to {} before the peak (at most {:.0} %): take more periods (test.periods) or damp the body (run.local_damping)",
                percent(off),
                100.0 * UNSTEADY
            ));
        }
        doubts
    }

    /// The doubts of a dynamic test.
    fn dynamic_doubts(&self) -> Vec<String> {
        let mut doubts = self.reasons.clone();
        let apart = self.figure(EQUILIBRIUM).unwrap_or(0.0);
        if apart.abs() > APART {
            doubts.push(format!(
                "the forces on the two ends differ by up to {} of the largest load between half of it and all of it, so the specimen was not in equilibrium (at most {:.0} %): take a longer rise (test.striker.rise_time), a shorter specimen or a slower striker",
                format_args!("{:.1} %", 100.0 * apart.abs()),
                100.0 * APART
            ));
        }
        let unbooked = self.figure(UNBOOKED).unwrap_or(0.0);
        if unbooked.abs() > MUCH {
            doubts.push(format!(
                "{} of the energy of the impact is unaccounted for: take a smaller step (run.safety_factor)",
                percent(unbooked)
            ));
        }
        if let (Some(t10), Some(most)) = (self.figure(T10), self.figure(LARGEST_T10))
            && most < 1.0 - MUCH
            && t10 > NEAR_CEILING * most
        {
            doubts.push(format!(
                "t10 is {}, and cannot exceed {}, the share of the spheres that are smaller than a tenth of the body: their size decides, and not the material; take smaller spheres",
                significant(t10, 3),
                significant(most, 3)
            ));
        }
        doubts.extend(self.misplaced_crack());
        let needs_strength = self.target_strength_pa.is_some() && self.kind != TestType::DropWeight;
        if needs_strength && !self.broken {
            doubts.push(
                "the load did not fall to half of its largest before the pulse ended, so there is no strength: take a faster or a longer striker (test.striker)"
                    .to_owned(),
            );
        }
        doubts
    }

    /// Fraction of the bonds that broke; 0 without bonds.
    fn broken_share(&self) -> f64 {
        let [broken, all] = self.broken_bonds;
        broken as f64 / all.max(1) as f64
    }

    /// Results other than the table of numbers, of a test with steps: rate, breakage, first broken
    /// bond, position of the crack, effect of the rate. Each with a name.
    pub fn sentences(&self) -> Vec<(String, String)> {
        let mut found = Vec::new();
        let mut say = |name: &str, text: String| found.push((name.to_owned(), text));
        // Without steps there is no rate, and nothing breaks.
        if self.rate_m_s == 0.0 {
            return found;
        }
        say(
            if self.is_dynamic() { "impact" } else { "rate" },
            format!(
                "{}; lowest frequency about {} Hz",
                show_quantity(self.rate_m_s, "m/s"),
                significant(self.lowest_frequency_hz, 3)
            ),
        );
        if !self.broken && !self.is_dynamic() {
            let [broken, all] = self.broken_bonds;
            say(
                "broken",
                format!(
                    "no, the load did not fall to half of its largest; {broken} of {all} bonds broke"
                ),
            );
        }
        if let Some(first) = &self.first_broken {
            let place = first.place_m.map(|x| significant(1e3 * x, 4)).join(", ");
            say(
                "first bond",
                format!(
                    "at {}, crosshead travel {}, {} at [{place}] mm",
                    show_quantity(first.force_n, "N"),
                    show_quantity(first.travel_m, "m"),
                    first.cause.phrase(),
                ),
            );
        }
        if let Some(crack) = &self.crack {
            let is = if crack.is_within {
                "within"
            } else {
                "not within"
            };
            say(
                "crack",
                format!(
                    "{} broken bonds, mean {} from the middle, standard deviation {}; {is} {}, as are {:.0} % of them",
                    crack.bonds,
                    show_quantity(crack.offset_m, "m"),
                    show_quantity(crack.spread_m, "m"),
                    show_quantity(crack.within_m, "m"),
                    100.0 * crack.fraction_within
                ),
            );
        }
        if !self.half_the_rate_changes.is_empty() {
            let changes = self.half_the_rate_changes.iter();
            let listed: Vec<String> = changes
                .map(|figure| format!("{} by {}", figure.name, percent(figure.value)))
                .collect();
            say("half the rate", format!("changes {}", listed.join(", ")));
        }
        found
    }
}

impl TestResult {
    /// Human-readable lines. Those of `unresolved` figures, by name, end with a `*`.
    pub fn text(&self, unresolved: &[String]) -> String {
        let mut text = format!("test         {}\n", self.kind.name());
        let tables = [&self.dimensions, &self.figures, &self.calibration];
        let names = tables.into_iter().flatten().map(|figure| figure.name.len());
        let width = names.max().unwrap_or_default();
        for figure in tables.into_iter().flatten() {
            let mark = if unresolved.contains(&figure.name) {
                "*"
            } else {
                ""
            };
            text += &format!("  {}{mark}\n", line(figure, width));
        }
        for (name, sentence) in self.sentences() {
            text += &format!("  {name:width$} {sentence}\n");
        }
        text
    }
}

fn line(figure: &Figure, width: usize) -> String {
    let mut text = format!(
        "{:width$} {}",
        figure.name,
        show_quantity(figure.value, &figure.unit)
    );
    if let (Some(theory), Some(error)) = (figure.theory, figure.error) {
        text += &format!(
            "   {} {}   deviation {}",
            figure.theory_is.unwrap_or(Source::Target).name(),
            show_quantity(theory, &figure.unit),
            percent(error)
        );
    }
    text
}

/// A fraction as a percentage with its sign.
fn percent(fraction: f64) -> String {
    format!("{:+.1} %", 100.0 * fraction)
}
