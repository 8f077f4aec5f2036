//! First slopes of the results of several tests, d ln(result)/d ln(number), where they are known.

use dem_calibration::Free;
use dem_laboratory::test_result::STIFFNESS;
use dem_laboratory::theory::PEAK_AXIAL_STRESS;
use dem_rig::evaluate::{BY_TRAVEL, EQ_18, MODULUS, STRENGTH};

/// The slope of a result over the numbers of an unknown, of all that are free: moduli and strengths
/// of a body are nearly proportional to those of its bonds. None: it is not known, and a round
/// finds it, such as which of several strengths a test depends on.
pub(super) fn slope(result: &str, unknown: &Free, all: &[Free]) -> Option<f64> {
    let is_modulus_of_body = [STIFFNESS, EQ_18, BY_TRAVEL, MODULUS].contains(&result);
    let is_strength_of_body = [STRENGTH, PEAK_AXIAL_STRESS].contains(&result);
    let is_only = all.iter().filter(|one| is_failure(one)).count() == 1;
    let is_angle = unknown.numbers[0].path.ends_with(".friction_angle");
    match (is_bond_modulus(unknown), is_failure(unknown)) {
        (true, _) if is_modulus_of_body => Some(1.0),
        (true, _) if is_strength_of_body => Some(0.0),
        (_, true) if is_modulus_of_body => Some(0.0),
        (_, true) if is_strength_of_body && is_only && !is_angle => Some(1.0),
        _ => None,
    }
}

/// Whether an unknown is the modulus of bonds.
pub(super) fn is_bond_modulus(unknown: &Free) -> bool {
    let path = &unknown.numbers[0].path;
    path.starts_with("bonds.") && path.ends_with(".young_modulus")
}

/// Whether an unknown is a number of the failure of bonds.
pub(super) fn is_failure(unknown: &Free) -> bool {
    unknown.numbers[0].path.contains(".failure.")
}
