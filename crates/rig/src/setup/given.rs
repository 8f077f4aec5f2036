//! Dimensions of a test that the scene, the measured specimen and the body give differently.

use dem_io::units::{show_quantity, significant};
use dem_scene::Test;

/// Largest difference of two dimensions that is not named.
const NAMED: f64 = 0.02;
/// Difference of the body from the measured specimen at which it is another specimen, and from a
/// dimension of the scene at which this is doubtful.
const ANOTHER: f64 = 0.25;
/// Largest difference of a dimension of the scene from the body that is not named: an embossed
/// body is larger than its section.
const GIVEN: f64 = 0.05;

/// Notes and warnings on the dimensions of a test, a sentence each.
#[derive(Debug, Default)]
pub(super) struct Said {
    pub(super) notes: Vec<String>,
    pub(super) warnings: Vec<String>,
}

/// The dimension `name` for the formulas of a test, m or m2: the one that the scene gives, or that
/// of the measured specimen, unless the body is another specimen, or that of the body.
pub(super) fn dimension(
    test: &Test,
    name: &str,
    given: Option<f64>,
    of_body: f64,
    said: &mut Said,
) -> f64 {
    let unit = if name == "area" { "m2" } else { "m" };
    let show = |value: f64| show_quantity(value, unit);
    let rig = test.measured.as_ref().and_then(|measured| {
        let rig = measured.material.dimensions.get(name)?;
        Some((rig, measured.file.display().to_string()))
    });
    let apart = |one: f64, other: f64| (one / other - 1.0).abs();
    let percent = |one: f64, other: f64| significant(100.0 * (one / other - 1.0), 3);
    match (given, rig) {
        (Some(given), Some((rig, file))) => {
            if apart(given, rig) > NAMED {
                said.notes.push(format!(
                    "test.{name} is {}, and the measured specimen ({file}) has {}",
                    show(given),
                    show(rig)
                ));
            }
            given
        }
        (None, Some((rig, file))) if apart(of_body, rig) <= ANOTHER => {
            if apart(of_body, rig) > NAMED {
                said.notes.push(format!(
                    "the {name} is {}, that of the measured specimen ({file}); the box around the body '{}' has {} ({} %): write test.{name} to take another",
                    show(rig),
                    test.body,
                    show(of_body),
                    percent(of_body, rig)
                ));
            }
            rig
        }
        (None, Some((rig, file))) => {
            said.notes.push(format!(
                "the {name} is {}, that of the body '{}', which is another specimen than the measured one ({file}) with {}: its curve is scaled",
                show(of_body),
                test.body,
                show(rig)
            ));
            of_body
        }
        (None, None) => of_body,
        (Some(given), None) => given,
    }
}

/// Compares a dimension of the scene with that of the box around the body.
pub(super) fn compare_with_body(
    test: &Test,
    name: &str,
    given: Option<f64>,
    of_body: f64,
    said: &mut Said,
) {
    let Some(given) = given else { return };
    let apart = (given / of_body - 1.0).abs();
    let sentence = format!(
        "test.{name} is {}, and the box around the body '{}' has {}",
        show_quantity(given, "m"),
        test.body,
        show_quantity(of_body, "m")
    );
    if apart > ANOTHER {
        said.warnings.push(sentence + ": check the unit");
    } else if apart > GIVEN {
        said.notes.push(sentence);
    }
}

/// Compares a span of the scene with the distance of the pins.
pub(super) fn compare_with_pins(name: &str, given: Option<f64>, of_pins_m: f64, said: &mut Said) {
    if let Some(given) = given.filter(|given| (given / of_pins_m - 1.0).abs() > GIVEN) {
        said.warnings.push(format!(
            "test.{name} is {}, and the pins are {} apart: correct it, or remove it, and it is measured",
            show_quantity(given, "m"),
            show_quantity(of_pins_m, "m")
        ));
    }
}
