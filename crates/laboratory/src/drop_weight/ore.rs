//! An ore: the law of breakage that drop-weight tests give, and what speaks against it.

use dem_io::units::significant;
use dem_io::{Diagnostic, Result};
use dem_physics::breakage::BreakageLaw;
use serde::Serialize;

use super::broken_fit::{BrokenFit, fit_broken};
use super::estimate::Estimate;
use super::family_fit::{FamilyMisfit, fit_family};
use super::refused::percent;
use super::sheet::{DropWeightSheets, DropWeightTest};
use super::size::{SizeGroup, geometric_mean, size_groups};
use super::t10_fit::{EnergyFrom, T10Data, T10Fit};
use crate::student::{NORMAL, student_95};
use crate::units::J_KG_OF_KWH_T;

/// Sizes that differ by less than this factor in all say nothing of exponents.
const SIZES_APART: f64 = 1.3;
/// A larger factor between the energies is needed to tell A from b.
const ENERGIES_APART: f64 = 1.2;
/// Misfit of a t_n that is named.
const MISFIT: f64 = 0.05;
/// Mean residual of a size that is named, if it is significant.
const OFF: f64 = 0.02;
/// A x b of ores, t/kWh.
const USUAL_A_TIMES_B: [f64; 2] = [0.02, 10.0];
/// Largest measured t10 over A, below which A is extrapolated.
const BENT: f64 = 0.6;

/// Residuals of t10 of tests of like size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SizeResidual {
    /// Size, m.
    pub size_m: f64,
    /// Number of tests.
    pub tests: usize,
    /// Mean of measured minus fitted t10.
    pub mean: f64,
    /// Root of the mean square.
    pub rms: f64,
}

/// The law of breakage of an ore, from its drop-weight tests.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedOre {
    /// The law.
    pub law: BreakageLaw,
    /// A.
    pub largest_t10: Estimate,
    /// b, kg/J.
    pub b_kg_j: Estimate,
    /// A times b, kg/J: the slope of t10 at small energies, by which ores are ranked.
    pub a_times_b_kg_j: Estimate,
    /// E_0, J/kg.
    pub fracture_energy_j_kg: Estimate,
    /// Standard deviation of the logarithm of fracture energies.
    pub energy_scatter: Estimate,
    /// Power of the size with which b grows.
    pub b_exponent: Estimate,
    /// Power of the size with which fracture energies fall.
    pub energy_exponent: Estimate,
    /// Exponent of the family.
    pub family_exponent: Estimate,
    /// Number of tests with a t10.
    pub tests: usize,
    /// Root of the mean square of measured minus fitted t10.
    pub rms: f64,
    /// By size, the smallest first.
    pub by_size: Vec<SizeResidual>,
    /// By n of the family.
    pub family: Vec<FamilyMisfit>,
    /// What could not be fitted, and what speaks against the fit, a sentence each.
    pub doubts: Vec<String>,
}

/// Fits the law of breakage.
///
/// # Errors
/// Fewer tests than numbers to fit; tests at one energy; no fragments.
pub fn fit_ore(sheets: &DropWeightSheets) -> Result<FittedOre> {
    let groups = size_groups(&sheets.tests);
    let tests: Vec<&DropWeightTest> = (sheets.tests.iter())
        .filter(|test| test.t10.is_some())
        .collect();
    let fits_size = are_apart(tests.iter().map(|test| test.size_m), SIZES_APART);
    let reference_size_m = reference_size_m(&groups);
    let mut doubts = Vec::new();
    let broken = broken(&sheets.tests, reference_size_m, &mut doubts);
    let data = T10Data {
        tests: &tests,
        reference_size_m,
        fits_size,
        broken: broken.as_ref(),
    };
    refuse_too_few(sheets, &data)?;
    let fit = data.fit();
    let (family_exponent, family) = fit_family(&sheets.tests);
    let law = BreakageLaw {
        family_exponent: family_exponent.value,
        ..fit.law
    };
    let by_size = by_size(&sheets.tests, &groups, &law);
    let count = tests.len() as f64;
    let squares = by_size
        .iter()
        .map(|one| one.tests as f64 * one.rms * one.rms);
    let rms = (squares.sum::<f64>() / count).sqrt();
    let largest = tests.iter().filter_map(|test| test.t10).fold(0.0, f64::max);
    doubts.extend(doubts_of(&fit, fits_size, broken.is_some(), largest));
    doubts.extend(by_size.iter().filter_map(|one| size_doubt(one, rms)));
    doubts.extend(family_doubts(&family));
    let of_broken = |value: fn(&BrokenFit) -> Estimate| broken.as_ref().map(value);
    Ok(FittedOre {
        law,
        fracture_energy_j_kg: of_broken(energy_of).unwrap_or(fit.fracture_energy_j_kg),
        energy_scatter: of_broken(scatter_of).unwrap_or(Estimate::assumed(0.0)),
        energy_exponent: of_broken(exponent_of).unwrap_or(fit.b_exponent),
        largest_t10: fit.largest_t10,
        b_kg_j: fit.b_kg_j,
        a_times_b_kg_j: fit.a_times_b_kg_j,
        b_exponent: fit.b_exponent,
        family_exponent,
        tests: tests.len(),
        rms,
        by_size,
        family,
        doubts,
    })
}

/// Whether the largest of these values is the smallest times this factor or more.
fn are_apart(values: impl Iterator<Item = f64>, factor: f64) -> bool {
    let ends = values.fold([f64::INFINITY, 0.0], |[least, most], value| {
        [value.min(least), value.max(most)]
    });
    ends[1] >= factor * ends[0]
}

/// Geometric mean of the sizes, rounded to three digits of mm: the numbers of the law depend least
/// on each other there.
fn reference_size_m(groups: &[SizeGroup]) -> f64 {
    let mean_mm = 1e3 * geometric_mean(groups.iter().map(|group| group.size_m));
    let rounded: Option<f64> = format!("{mean_mm:.2e}").parse().ok();
    rounded.unwrap_or(mean_mm) / 1e3
}

/// Fracture energies from the broken specimens. None: none are given, or they say nothing, which is
/// then a doubt.
fn broken(
    tests: &[DropWeightTest],
    reference_size_m: f64,
    doubts: &mut Vec<String>,
) -> Option<BrokenFit> {
    let sizes = tests
        .iter()
        .filter(|test| test.broken.is_some())
        .map(|test| test.size_m);
    if tests.iter().all(|test| test.broken.is_none()) {
        return None;
    }
    match fit_broken(tests, reference_size_m, are_apart(sizes, SIZES_APART)) {
        Ok(mut fit) => {
            let rows = tests.iter().filter(|test| test.broken.is_some()).count() as f64;
            if let Some(dispersion) = fit.dispersion
                && dispersion > 1.0 + 3.0 * (2.0 / rows).sqrt()
            {
                doubts.push(format!(
                    "numbers of broken specimens scatter {} times as much as by chance: their law, or a row, is off; the intervals allow for it",
                    significant(dispersion.sqrt(), 3)
                ));
                fit.covariance *= dispersion;
            }
            Some(fit)
        }
        Err(why) => {
            doubts.push(format!(
                "the broken specimens do not give the fracture energies: {why}"
            ));
            None
        }
    }
}

fn energy_of(fit: &BrokenFit) -> Estimate {
    Estimate::within_factor(
        fit.energy_j_kg,
        Some(NORMAL * fit.covariance[(0, 0)].sqrt()),
    )
}

fn scatter_of(fit: &BrokenFit) -> Estimate {
    Estimate::within_factor(fit.scatter, Some(NORMAL * fit.covariance[(2, 2)].sqrt()))
}

fn exponent_of(fit: &BrokenFit) -> Estimate {
    let variance = fit.covariance[(1, 1)];
    if variance == 0.0 {
        return Estimate::assumed(0.0);
    }
    Estimate::within(fit.exponent, Some(NORMAL * variance.sqrt()))
}

fn refuse_too_few(sheets: &DropWeightSheets, data: &T10Data<'_>) -> Result<()> {
    let place = sheets.files.join(", ");
    let refuse = |problem: String, remedy: &str| Err(Diagnostic::input(&place, problem, remedy));
    let (count, values) = (data.tests.len(), data.fewest_values());
    if count <= values {
        let names = if data.fits_size {
            "A, b and the size exponent"
        } else {
            "A and b"
        };
        let problem = format!(
            "{count} rows with a t10 for {values} numbers ({names}), at least {} are needed to tell their scatter",
            values + 1
        );
        return refuse(problem, "add tests, or further sheets of this ore");
    }
    if data.tests.iter().all(|test| test.t10 == Some(0.0)) {
        return refuse("every t10 is 0".to_owned(), "test with larger energies");
    }
    if !are_apart(
        data.tests.iter().map(|test| test.energy_j_kg),
        ENERGIES_APART,
    ) {
        let energy = data.tests[0].energy_j_kg / J_KG_OF_KWH_T;
        let problem = format!(
            "all energies are near {} kWh/t, within a factor of {ENERGIES_APART}: A and b cannot be told apart",
            significant(energy, 3)
        );
        return refuse(problem, "add tests at other energies");
    }
    Ok(())
}

fn by_size(tests: &[DropWeightTest], groups: &[SizeGroup], law: &BreakageLaw) -> Vec<SizeResidual> {
    let of = |group: &SizeGroup| {
        let off = group.tests.iter().filter_map(|at| {
            let test = &tests[*at];
            Some(test.t10? - law.mean_t10(test.size_m, test.energy_j_kg))
        });
        let off: Vec<f64> = off.collect();
        let count = off.len() as f64;
        SizeResidual {
            size_m: group.size_m,
            tests: off.len(),
            mean: off.iter().sum::<f64>() / count,
            rms: (off.iter().map(|off| off * off).sum::<f64>() / count).sqrt(),
        }
    };
    groups.iter().map(of).filter(|one| one.tests > 0).collect()
}

/// What could not be fitted, and how far to trust A and b.
fn doubts_of(fit: &T10Fit, fits_size: bool, has_broken: bool, largest: f64) -> Vec<String> {
    let mut doubts = Vec::new();
    if !fits_size {
        doubts.push("one size only: the size exponents are not fitted; 0 takes b and the fracture energy as independent of the size".to_owned());
    }
    match fit.energy_from {
        EnergyFrom::Broken => {}
        EnergyFrom::T10 => {}
        EnergyFrom::Insignificant => doubts.push(
            "the smallest energy is not significantly different from 0: it is written as 0, which the intervals take for granted"
                .to_owned(),
        ),
        EnergyFrom::TooFewTests => {
            doubts.push("too few tests for a smallest energy: it is written as 0, which the intervals take for granted".to_owned());
        }
    }
    if !has_broken {
        doubts.push("without numbers of broken specimens the scatter of fracture energies is unknown: it is written as 0, and their size exponent as that of b".to_owned());
    }
    if !fit.largest_t10.is_fitted {
        doubts.push("A is at its bound of 1: the tests do not show where t10 ends, and the interval of b holds for this A".to_owned());
    } else if largest < BENT * fit.law.largest_t10 {
        doubts.push(format!(
            "A of {} % is extrapolated: the largest t10 is {} %",
            percent(fit.law.largest_t10),
            percent(largest)
        ));
    }
    let product_t_kwh = fit.law.largest_t10 * fit.law.b_kg_j * J_KG_OF_KWH_T;
    let [least, most] = USUAL_A_TIMES_B;
    if !(least..=most).contains(&product_t_kwh) {
        doubts.push(format!(
            "A x b is {} t/kWh, not between {least} and {most} as of ores: check the units of energy and t10",
            significant(product_t_kwh, 3)
        ));
    }
    doubts
}

/// A size whose tests lie on one side of the fit.
fn size_doubt(one: &SizeResidual, rms: f64) -> Option<String> {
    let count = one.tests as f64;
    let allowed = student_95(one.tests.saturating_sub(1).max(1)) * rms / count.sqrt();
    (one.tests > 1 && one.mean.abs() > OFF.max(allowed)).then(|| {
        format!(
            "at {} mm t10 is {} points {} the fit in the mean of {} tests: the size exponent does not hold for it",
            significant(1e3 * one.size_m, 3),
            percent(one.mean.abs()),
            if one.mean > 0.0 { "above" } else { "below" },
            one.tests
        )
    })
}

fn family_doubts(family: &[FamilyMisfit]) -> Vec<String> {
    if family.is_empty() {
        return vec!["no family is given: its exponent is the mean of 41 tests on granite, gneiss and quartzite (Rae et al. 2020)".to_owned()];
    }
    let bad = family.iter().filter(|one| one.rms > MISFIT);
    bad.map(|one| format!("t{} is {} points off the family", one.n, percent(one.rms)))
        .collect()
}
