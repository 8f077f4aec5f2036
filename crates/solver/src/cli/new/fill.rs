//! The marks of a template: `@0.5*x@`, `@nip+0.55*z@`, `@height@`.

use std::f64::consts::PI;

use dem_io::units::significant;

/// A number with its SI unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Value {
    pub(super) si: f64,
    pub(super) unit: &'static str,
}

impl Value {
    pub(super) fn new(si: f64, unit: &'static str) -> Self {
        Self { si, unit }
    }

    pub(super) fn length(metres: f64) -> Self {
        Self::new(metres, "m")
    }

    /// With six digits, in a unit that suits its size.
    pub(super) fn text(self) -> String {
        let size = self.si.abs();
        let (factor, unit) = match self.unit {
            "m" if size < 1.0 => (1e3, "mm"),
            "s" if size < 1e-3 => (1e6, "us"),
            "s" if size < 1.0 => (1e3, "ms"),
            "kg" if size < 1e-3 => (1e6, "mg"),
            "kg" if size < 1.0 => (1e3, "g"),
            "rad/s" => (30.0 / PI, "rpm"),
            unit => (1.0, unit),
        };
        format!("{} {unit}", significant(factor * self.si, 6))
    }
}

/// The text with each mark replaced by its value: a sum of named values with factors.
pub(super) fn filled(template: &str, weight: &str, values: &[(&str, Value)]) -> String {
    let template = template.replace("@weight@", weight);
    // Text and marks in turn.
    let parts = template.split('@').enumerate();
    let texts = parts.map(|(k, part)| {
        if k % 2 == 0 {
            part.to_owned()
        } else {
            sum(part, values).text()
        }
    });
    texts.collect()
}

/// The value of `nip-0.55*z`. Not a number if a name is unknown, which a test excludes.
fn sum(mark: &str, values: &[(&str, Value)]) -> Value {
    let signed = mark.replace('-', "+-");
    let terms = signed.split('+').filter(|term| !term.is_empty());
    let terms = terms.map(|term| {
        let (factor, name) = term.split_once('*').unwrap_or(("1", term));
        let factor: f64 = factor.parse().unwrap_or(f64::NAN);
        let value = values.iter().find(|(known, _)| *known == name);
        let value = value.map_or(Value::length(f64::NAN), |(_, value)| *value);
        Value::new(factor * value.si, value.unit)
    });
    let add = |sum: Value, term: Value| Value::new(sum.si + term.si, term.unit);
    terms.reduce(add).unwrap_or(Value::length(f64::NAN))
}
