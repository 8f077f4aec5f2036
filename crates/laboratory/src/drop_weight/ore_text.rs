//! The numbers of an ore as text: a table, and the file that scenes include.

use dem_io::text::{counted, visible};
use dem_io::units::significant;

use super::estimate::Estimate;
use super::ore::FittedOre;
use super::refused::percent;
use super::sheet::DropWeightSheets;
use crate::units::J_KG_OF_KWH_T;

/// Digits of intervals and of numbers that a person reads.
const SHOWN: usize = 3;
/// Digits of the numbers that scenes read.
const WRITTEN: usize = 6;

/// A number of the law for a person.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OreNumber {
    /// Its name.
    pub name: &'static str,
    /// Its value and unit.
    pub value: String,
    /// Its 95 % confidence interval, or where it comes from.
    pub interval: String,
}

/// The numbers of the law, with their intervals.
pub fn ore_numbers(ore: &FittedOre) -> Vec<OreNumber> {
    let number = |name, estimate: &Estimate, factor: f64, unit: &'static str| {
        let shown = |value: f64| significant(factor * value, SHOWN);
        let range = estimate
            .interval
            .map(|[low, high]| format!("{} to {}", shown(low), shown(high)));
        OreNumber {
            name,
            value: format!("{} {unit}", shown(estimate.value))
                .trim_end()
                .to_owned(),
            interval: match (range, estimate.is_fitted) {
                (Some(range), true) => range,
                (Some(range), false) => format!("{range}, at its bound"),
                (None, true) => "not known".to_owned(),
                (None, false) => "not fitted".to_owned(),
            },
        }
    };
    let per_t = 1.0 / J_KG_OF_KWH_T;
    vec![
        number("A", &ore.largest_t10, 100.0, "%"),
        number("b", &ore.b_kg_j, J_KG_OF_KWH_T, "t/kWh"),
        number(
            "A x b, A in %",
            &ore.a_times_b_kg_j,
            100.0 * J_KG_OF_KWH_T,
            "t/kWh",
        ),
        number("fracture energy", &ore.fracture_energy_j_kg, per_t, "kWh/t"),
        number("energy scatter", &ore.energy_scatter, 1.0, ""),
        number("b exponent", &ore.b_exponent, 1.0, ""),
        number("energy exponent", &ore.energy_exponent, 1.0, ""),
        number("family exponent", &ore.family_exponent, 1.0, ""),
    ]
}

/// The file that scenes include. `made`: date and program; `material`: name of the material.
pub fn ore_text(
    ore: &FittedOre,
    sheets: &DropWeightSheets,
    made: [&str; 2],
    material: &str,
) -> String {
    let sizes: Vec<String> = ore.by_size.iter().map(|one| shown_mm(one.size_m)).collect();
    let [date, program] = made;
    let mut lines = vec![
        format!("Fitted on {date} by {program} to drop-weight tests."),
        format!("Sheets: {}.", sheets.files.join(", ")),
        format!("Sizes: {}.", sizes.join(", ")),
        format!(
            "{} with a t10, {} points off the law in root mean square.",
            counted(ore.tests, "row"),
            percent(ore.rms)
        ),
    ];
    if !sheets.ore.is_empty() {
        lines.insert(1, format!("Ore: {}.", sheets.ore));
    }
    let number = |one: OreNumber| {
        format!(
            "{}: {}, 95 % confidence interval: {}",
            one.name, one.value, one.interval
        )
    };
    lines.extend(ore_numbers(ore).into_iter().map(number));
    lines.extend(ore.doubts.iter().map(|doubt| format!("doubt: {doubt}")));
    lines.extend(sheets.notes.iter().map(|note| format!("note: {note}")));
    let comments: String = lines
        .iter()
        .map(|line| format!("# {}\n", visible(line)))
        .collect();
    format!("{comments}\n[materials.{material}.breakage]\n{}", keys(ore))
}

/// The keys of the law.
fn keys(ore: &FittedOre) -> String {
    let law = &ore.law;
    let written = |value: f64| significant(value, WRITTEN);
    let per_t = |energy_j_kg: f64| written(energy_j_kg / J_KG_OF_KWH_T);
    let lines = [
        ("largest_t10", plain(law.largest_t10)),
        (
            "b",
            format!("\"{} t/kWh\"", written(law.b_kg_j * J_KG_OF_KWH_T)),
        ),
        (
            "fracture_energy",
            format!("\"{} kWh/t\"", per_t(law.fracture_energy_j_kg)),
        ),
        ("energy_scatter", plain(law.energy_scatter)),
        (
            "reference_size",
            format!("\"{} mm\"", written(1e3 * law.reference_size_m)),
        ),
        ("b_exponent", plain(law.b_exponent)),
        ("energy_exponent", plain(law.energy_exponent)),
        ("family_exponent", plain(law.family_exponent)),
    ];
    lines
        .iter()
        .map(|(key, value)| format!("{key} = {value}\n"))
        .collect()
}

/// A number as TOML writes one that is not whole.
fn plain(value: f64) -> String {
    let text = significant(value, WRITTEN);
    if text.contains(['.', 'e']) {
        text
    } else {
        format!("{text}.0")
    }
}

pub(super) fn shown_mm(size_m: f64) -> String {
    format!("{} mm", significant(1e3 * size_m, SHOWN))
}
