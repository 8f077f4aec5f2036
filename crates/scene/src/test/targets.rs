//! Targets of a test: its own modulus and strength beside those of its measured material.

use dem_io::diagnostic::Result;
use dem_io::units::show_quantity;
use dem_laboratory::{MeasuredMaterial, TestType};
use std::path::PathBuf;

use super::super::field::Field;
use super::super::table::Table;
use super::super::tree::Origin;

/// A measured material and its file.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredReference {
    /// The file.
    pub file: PathBuf,
    /// Its content.
    pub material: MeasuredMaterial,
}

/// A target: the value that the scene gives, and the one that was measured, Pa.
pub(super) struct Target {
    key: &'static str,
    given_pa: Option<f64>,
    measured_pa: Option<f64>,
    /// The measured one counts: its file is given on the command line, the other is not.
    measured_counts: bool,
}

impl Target {
    pub(super) fn taken_pa(&self) -> Option<f64> {
        if self.measured_counts {
            self.measured_pa.or(self.given_pa)
        } else {
            self.given_pa.or(self.measured_pa)
        }
    }
}

/// Modulus and strength with which the test is compared.
pub(super) fn targets(
    table: &Table<'_>,
    measured: Option<&MeasuredReference>,
) -> Result<[Target; 2]> {
    let material = measured.map(|measured| &measured.material);
    let modulus = material.and_then(|material| material.young_modulus_pa);
    let strength = material.map(|material| material.strength_pa);
    let is_option = |field: &Field<'_>| matches!(field.node.origin, Origin::Option(_));
    let measured_is_option = table.get("measured").is_some_and(|field| is_option(&field));
    let target = |key, measured: Option<f64>| {
        let given = table.get(key);
        Ok(Target {
            key,
            given_pa: table.read(key)?,
            measured_pa: measured,
            measured_counts: measured_is_option && !given.is_some_and(|field| is_option(&field)),
        })
    };
    Ok([
        target("young_modulus", modulus.map(|modulus| modulus.mean))?,
        target("strength", strength.map(|strength| strength.mean))?,
    ])
}

/// What a test says twice: modulus or strength of its own beside those of its measured material.
pub(super) fn conflicts(
    table: &Table<'_>,
    kind: TestType,
    measured: &MeasuredReference,
) -> Result<Vec<String>> {
    let file = measured.file.display();
    let told = |target: Target| {
        let (given_pa, measured_pa) = (target.given_pa?, target.measured_pa?);
        if (given_pa - measured_pa).abs() <= SAME * measured_pa.abs() {
            return None;
        }
        let [given, found] = [given_pa, measured_pa].map(|value| show_quantity(value, "Pa"));
        let key = target.key;
        Some(if target.measured_counts {
            format!(
                "the target is {found}, measured ({file}, given on the command line), and not test.{key} = {given} of the scene"
            )
        } else {
            format!(
                "the target is test.{key} = {given}, and not {found}, measured ({file}): remove test.{key} to take that"
            )
        })
    };
    let targets = targets(table, Some(measured))?;
    let without = modulus_not_measured(kind, measured, &targets);
    Ok((targets.into_iter().filter_map(told))
        .chain(without)
        .collect())
}

/// What is said of a modulus beside a measured material that has none.
fn modulus_not_measured(
    kind: TestType,
    measured: &MeasuredReference,
    [modulus, _]: &[Target; 2],
) -> Option<String> {
    let file = measured.file.display();
    let (given_pa, None) = (modulus.given_pa?, modulus.measured_pa) else {
        return None;
    };
    let given = show_quantity(given_pa, "Pa");
    Some(match kind {
        TestType::BrazilianDisc => format!(
            "calibrations meet the stiffness of the measured curve ({file}), and test.young_modulus = {given} only with --modulus specimen"
        ),
        _ => format!("the target is test.young_modulus = {given}: {file} has no modulus"),
    })
}

/// Largest difference of a target from the measured value at which they count as the same.
const SAME: f64 = 1e-6;
