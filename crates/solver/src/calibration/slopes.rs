//! First slopes of the results of several tests: d ln(result)/d ln(number), by closed forms and
//! from experience. Rounds correct them.

use dem_calibration::Free;
use dem_laboratory::TestType;
use dem_laboratory::test_result::STIFFNESS;
use dem_rig::evaluate::{BY_TRAVEL, EQ_18, MODULUS};
use dem_scene::BondFailure;

use super::joint::{TestScene, is_strength};

/// Share of the strengths of bonds by which a body mostly fails, and of the others.
const SHARES: [f64; 2] = [0.7, 0.3];

/// The slope of a result over the numbers of an unknown. None: it is not known, and a round finds
/// it.
pub(super) fn slope(test: &TestScene, result: &str, unknown: &Free) -> Option<f64> {
    let path = unknown.numbers[0].path.as_str();
    let of_modulus = [STIFFNESS, EQ_18, BY_TRAVEL, MODULUS].contains(&result);
    let is_bond_modulus = path.starts_with("bonds.") && path.ends_with(".young_modulus");
    let is_failure = path.contains(".failure.");
    if of_modulus && (is_bond_modulus || is_failure) {
        return Some(if is_bond_modulus { 1.0 } else { 0.0 });
    }
    if !is_strength(result) || !(is_bond_modulus || is_failure) {
        return None;
    }
    if is_bond_modulus {
        return Some(0.0);
    }
    let kind = test.scene.test.as_ref()?.kind;
    let failure = failure_of(test)?;
    if path.ends_with(".friction_angle") {
        return Some(of_angle(kind, pressure_pa(test), &failure));
    }
    let is_shear = |path: &str| {
        let shear = ["cohesion", "shear_strength", "compressive_strength"];
        shear.iter().any(|key| path.ends_with(key))
    };
    // A factor on all strengths leaves a part that only the friction angle gives.
    let without_friction = cohesion_share(kind, pressure_pa(test), &failure);
    let shears = matches!(
        kind,
        TestType::Compression | TestType::TriaxialCompression | TestType::DirectShear
    );
    let kinds = |wanted: bool| {
        let mut numbers = unknown.numbers.iter();
        numbers.any(|number| is_shear(&number.path) == wanted)
    };
    let mostly = if kinds(shears) { SHARES[0] } else { 0.0 };
    let besides = if kinds(!shears) { SHARES[1] } else { 0.0 };
    // Bonds without strengths of the other sort fail by what they have.
    let share = match has_both(&failure) {
        true => mostly + besides,
        false => 1.0,
    };
    Some(share * without_friction)
}

/// The failure criteria of the tested body's bonds.
fn failure_of(test: &TestScene) -> Option<&BondFailure> {
    let body = test.scene.bodies.get(&test.scene.test.as_ref()?.body)?;
    let bonds = test.scene.bonds.get(body.bond_kind.as_deref()?)?;
    Some(&bonds.failure)
}

/// Whether bonds have strengths in tension and in shear.
fn has_both(failure: &BondFailure) -> bool {
    let tension = failure
        .tensile_strength_pa
        .or(failure.von_mises_strength_pa);
    let shear = failure.cohesion_pa.or(failure.shear_strength_pa);
    tension.is_some() && shear.or(failure.compressive_strength_pa).is_some()
}

/// Pressure under which a test is done, Pa; 0 for others.
fn pressure_pa(test: &TestScene) -> f64 {
    let test = test.scene.test.as_ref();
    let confining = test.and_then(|test| Some(test.confinement.as_ref()?.pressure_pa));
    let normal = test.and_then(|test| Some(test.normal_stress.as_ref()?.stress_pa));
    confining.or(normal).unwrap_or(0.0)
}

/// The part of a strength under pressure that is proportional to the cohesion of Mohr and Coulomb:
/// c/(c + sigma tan phi) in shear, and 2 c cos phi/(2 c cos phi + 2 sigma_3 sin phi) of the axial
/// stress above the pressure (Jaeger, Cook and Zimmerman 2007, section 4.5).
fn cohesion_share(kind: TestType, pressure_pa: f64, failure: &BondFailure) -> f64 {
    let (Some(cohesion_pa), Some(angle)) = (failure.cohesion_pa, failure.friction_angle_rad) else {
        return 1.0;
    };
    match kind {
        TestType::DirectShear | TestType::TriaxialCompression => {
            cohesion_pa / (cohesion_pa + pressure_pa * angle.tan())
        }
        _ => 1.0,
    }
}

/// The slope over the friction angle phi of the same closed forms: of c + sigma tan phi in shear;
/// of 2 (c cos phi + sigma_3 sin phi)/(1 - sin phi), the axial stress above the pressure, in
/// compression; 0 in other tests.
fn of_angle(kind: TestType, pressure_pa: f64, failure: &BondFailure) -> f64 {
    let (Some(c), Some(phi)) = (failure.cohesion_pa, failure.friction_angle_rad) else {
        return 0.0;
    };
    let (sin, cos) = phi.sin_cos();
    match kind {
        TestType::DirectShear => phi * pressure_pa / (cos * cos) / (c + pressure_pa * phi.tan()),
        TestType::TriaxialCompression | TestType::Compression => {
            let sum = c * cos + pressure_pa * sin;
            phi * ((pressure_pa * cos - c * sin) / sum + cos / (1.0 - sin))
        }
        _ => 0.0,
    }
}
