//! What no drop-weight test gives: a unit, a column or a row is wrong.

use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_physics::breakage::passing;

use super::sheet::DropWeightTest;
use super::size::{SizeGroup, size_groups};
use crate::fit::Line;
use crate::student::student_95;
use crate::units::J_KG_OF_KWH_T;
use dem_physics::breakage::USUAL_FAMILY_EXPONENT;

/// Energies over mass of tests, J/kg: ores take 0.001 to 10 kWh/t.
const ENERGIES_J_KG: [f64; 2] = [1e-4 * J_KG_OF_KWH_T, 100.0 * J_KG_OF_KWH_T];
/// Sizes of specimens, m.
const SIZES_M: [f64; 2] = [1e-5, 10.0];
/// A step between neighbouring energies as between units: kWh/t are 3600 J/kg.
const OTHER_UNIT: f64 = 50.0;
/// Part of the largest t10 that a test at a fiftieth of the energy does not reach.
const LITTLE: f64 = 0.1;
/// A larger energy by this factor with half the t10 or less, and this difference: refused; with
/// twice the energy a smaller difference suffices.
const LARGER: f64 = 1.5;
const MUCH_SMALLER: f64 = 0.5;
const DIFFERENCE: f64 = 0.1;
const TWICE: f64 = 2.0;
const DIFFERENCE_OF_TWICE: f64 = 0.03;
/// A t10 is compared with those of energies up to five times as large, if it should be this large;
/// a hundred times a fraction among percent is within these factors of it.
const NEAR: f64 = 0.2;
const NOTABLE: f64 = 0.08;
const HUNDREDFOLD: std::ops::Range<f64> = 0.5..3.0;
/// Shares that should be smaller are too close to 0 to be compared within a line.
const READABLE: f64 = 0.05;
const WRITE_PERCENT: &str = "write all in percent, or remove this line";

/// Refuses numbers of a row that no test gives.
pub(super) fn impossible(test: &DropWeightTest) -> Result<()> {
    let refuse =
        |problem: String, remedy: &str| Err(Diagnostic::input(&test.place, problem, remedy));
    let [least, most] = ENERGIES_J_KG;
    let energy_j_kg = test.energy_j_kg;
    if energy_j_kg <= 0.0 {
        let problem = format!(
            "the energy is {} J/kg, not above 0",
            significant(energy_j_kg, 4)
        );
        return refuse(problem, "correct or remove this line");
    }
    if !(least..=most).contains(&energy_j_kg) {
        let problem = format!(
            "the energy is {} kWh/t, not between {} and {}",
            kwh_t(energy_j_kg),
            kwh_t(least),
            kwh_t(most)
        );
        return refuse(problem, "check the unit of the energy");
    }
    let [least, most] = SIZES_M.map(|size_m| significant(1e3 * size_m, 4));
    if !(SIZES_M[0]..=SIZES_M[1]).contains(&test.size_m) {
        let size_mm = significant(1e3 * test.size_m, 4);
        let problem = format!("the size is {size_mm} mm, not between {least} mm and {most} mm");
        return refuse(problem, "check the unit of the size");
    }
    let mut family: Vec<[f64; 2]> = test.family.clone();
    family.extend(test.t10.map(|t10| [10.0, t10]));
    family.sort_by(|one, other| one[0].total_cmp(&other[0]));
    for pair in family.windows(2) {
        let [[n, coarse], [finer, fine]] = [pair[0], pair[1]];
        if fine > coarse {
            let problem = format!(
                "t{finer} is {} %, above t{n} with {} %: less passes a finer sieve",
                percent(fine),
                percent(coarse)
            );
            return refuse(
                problem,
                "check the order of the columns and the units of this line",
            );
        }
    }
    mixed_family(test)
}

/// Refuses a family in which one share is a hundredth of what another one of the line lets expect.
fn mixed_family(test: &DropWeightTest) -> Result<()> {
    let Some(t10) = test.t10 else { return Ok(()) };
    for [n, share] in &test.family {
        let from_t10 = passing(USUAL_FAMILY_EXPONENT, *n, t10);
        // The same with both sizes exchanged.
        let from_share = 1.0 - (1.0 - share).powf(((n - 1.0) / 9.0).powf(USUAL_FAMILY_EXPONENT));
        let is_hundredth = |share: f64, expected: f64| {
            expected > READABLE && HUNDREDFOLD.contains(&(100.0 * share / expected))
        };
        if is_hundredth(*share, from_t10) || is_hundredth(t10, from_share) {
            let problem = format!(
                "the t10 is {} %, but t{n} {} %: percent and fractions are mixed",
                percent(t10),
                percent(*share)
            );
            return Err(Diagnostic::input(&test.place, problem, WRITE_PERCENT));
        }
    }
    Ok(())
}

/// Whether two names are those of one ore.
pub(super) fn is_same_ore(one: &str, other: &str) -> bool {
    let plain = |name: &str| -> String {
        let letters = name.chars().filter(|c| c.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect()
    };
    plain(one) == plain(other)
}

/// Refuses two ores. Each has its name and its place.
pub(super) fn two_ores(ores: &[(String, String)]) -> Result<()> {
    let Some((first, first_place)) = ores.first() else {
        return Ok(());
    };
    match ores.iter().find(|(ore, _)| !is_same_ore(first, ore)) {
        Some((ore, place)) => {
            let [first, ore] = [first, ore].map(|name| name.escape_debug());
            let problem = format!("the ore is '{ore}', but '{first}' at {first_place}");
            let remedy = "fit each ore by itself, from a file of its own";
            Err(Diagnostic::input(place, problem, remedy))
        }
        None => Ok(()),
    }
}

/// Refuses tests that contradict each other.
pub(super) fn implausible(tests: &[DropWeightTest]) -> Result<()> {
    two_units(tests)?;
    for group in size_groups(tests) {
        mixed_percent(tests, &group)?;
        falling(tests, &group)?;
    }
    Ok(())
}

/// Refuses energies in two units: a wide gap between them, with like t10 on both sides.
fn two_units(tests: &[DropWeightTest]) -> Result<()> {
    let mut order: Vec<&DropWeightTest> = tests.iter().filter(|test| test.t10.is_some()).collect();
    order.sort_by(|one, other| one.energy_j_kg.total_cmp(&other.energy_j_kg));
    let largest =
        |tests: &[&DropWeightTest]| tests.iter().filter_map(|test| test.t10).fold(0.0, f64::max);
    for at in 1..order.len() {
        let [low, high] = [order[at - 1], order[at]];
        if high.energy_j_kg > OTHER_UNIT * low.energy_j_kg
            && largest(&order[..at]) > LITTLE * largest(&order[at..])
        {
            let problem = format!(
                "the energy is {} J/kg, {} times that of {} with none between, at a like t10: they are in two units",
                significant(high.energy_j_kg, 4),
                significant(high.energy_j_kg / low.energy_j_kg, 3),
                low.place
            );
            let remedy = "write all energies in one unit (1 kWh/t = 3600 J/kg), or each file's own into its head";
            return Err(Diagnostic::input(&high.place, problem, remedy));
        }
    }
    Ok(())
}

/// Refuses a t10 that is a hundredth of what a larger one at a near or lower energy lets expect.
fn mixed_percent(tests: &[DropWeightTest], group: &SizeGroup) -> Result<()> {
    for one in &group.tests {
        for other in &group.tests {
            let (Some(t10), Some(other_t10)) = (tests[*one].t10, tests[*other].t10) else {
                continue;
            };
            let factor = tests[*one].energy_j_kg / tests[*other].energy_j_kg;
            let expected = other_t10 * factor.min(1.0);
            let hundredfold = 100.0 * t10 / expected;
            if factor < NEAR || expected < NOTABLE || !HUNDREDFOLD.contains(&hundredfold) {
                continue;
            }
            let problem = format!(
                "the t10 is {} %, but {} % at {}: percent and fractions are mixed",
                percent(t10),
                percent(other_t10),
                tests[*other].place
            );
            return Err(Diagnostic::input(
                &tests[*one].place,
                problem,
                WRITE_PERCENT,
            ));
        }
    }
    Ok(())
}

/// Refuses a t10 that falls with the energy: of two tests by far, or of all by their trend.
fn falling(tests: &[DropWeightTest], group: &SizeGroup) -> Result<()> {
    let points: Vec<(usize, f64)> = (group.tests.iter())
        .filter_map(|at| Some((*at, tests[*at].t10?)))
        .collect();
    let refuse = |low: usize, high: usize, why: &str| {
        let problem = format!(
            "the t10 is {} % at {} kWh/t, but {} % at {} kWh/t at {}: {why}",
            percent(tests[high].t10.unwrap_or_default()),
            kwh_t(tests[high].energy_j_kg),
            percent(tests[low].t10.unwrap_or_default()),
            kwh_t(tests[low].energy_j_kg),
            tests[low].place
        );
        let remedy = "check both lines for swapped energies, sizes or columns";
        Err(Diagnostic::input(&tests[high].place, problem, remedy))
    };
    for (at, (low, t10)) in points.iter().enumerate() {
        for (high, higher) in &points[at + 1..] {
            let ratio = tests[*high].energy_j_kg / tests[*low].energy_j_kg;
            let difference = if ratio > TWICE {
                DIFFERENCE_OF_TWICE
            } else {
                DIFFERENCE
            };
            let is_smaller = *higher < MUCH_SMALLER * t10 && t10 - higher > difference;
            if ratio > LARGER && is_smaller {
                return refuse(*low, *high, "more energy does not make coarser pieces");
            }
        }
    }
    let energies: Vec<f64> = points
        .iter()
        .map(|(at, _)| tests[*at].energy_j_kg.ln())
        .collect();
    let t10s: Vec<f64> = points.iter().map(|(_, t10)| *t10).collect();
    let spread = energies
        .last()
        .zip(energies.first())
        .map_or(0.0, |(last, first)| last - first);
    if points.len() < 3 || spread < LARGER.ln() {
        return Ok(());
    }
    let line = Line::fitted(&energies, &t10s);
    let falls = line.slope * spread < -0.5 * DIFFERENCE;
    if falls && line.slope < -student_95(points.len() - 2) * line.slope_error {
        let [first, last] = [points[0].0, points[points.len() - 1].0];
        return refuse(
            first,
            last,
            "in all tests of this size it falls with the energy",
        );
    }
    Ok(())
}

pub(super) fn kwh_t(energy_j_kg: f64) -> String {
    significant(energy_j_kg / J_KG_OF_KWH_T, 4)
}

pub(super) fn percent(share: f64) -> String {
    significant(100.0 * share, 3)
}
