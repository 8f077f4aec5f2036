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

    /// In a unit that suits its size: lengths with six digits, as bodies must fit between walls,
    /// the rest with three.
    pub(super) fn text(self) -> String {
        let size = self.si.abs();
        let (factor, unit) = match self.unit {
            "m" if size < 1e-4 && size > 0.0 => (1e6, "um"),
            "m" if size < 1.0 => (1e3, "mm"),
            "s" if size < 1e-3 => (1e6, "us"),
            "s" if size < 1.0 => (1e3, "ms"),
            "kg" if size < 1e-3 => (1e6, "mg"),
            "kg" if size < 1.0 => (1e3, "g"),
            "rad/s" => (30.0 / PI, "rpm"),
            unit => (1.0, unit),
        };
        let digits = if self.unit == "m" { 6 } else { 3 };
        format!("{} {unit}", significant(factor * self.si, digits))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_sums_of_values() {
        let values = [("x", Value::length(0.02)), ("gap", Value::length(1e-3))];
        let fill = |text: &str| filled(text, "mass = 1", &values);
        assert_eq!(fill("@weight@ a @x@ b"), "mass = 1 a 20 mm b");
        assert_eq!(fill("@-0.5*x@, @gap-0.5*x@"), "-10 mm, -9 mm");
        assert_eq!(fill("@100*x+0.5*gap@"), "2.0005 m");
        assert!(fill("@y@").contains("NaN"));
    }

    #[test]
    fn units_suit_sizes() {
        let text = |si, unit| Value::new(si, unit).text();
        assert_eq!(text(1e-5, "m"), "10 um");
        assert_eq!(text(2e-3, "s"), "2 ms");
        assert_eq!(text(4.2e-4, "kg"), "420 mg");
        assert_eq!(text(0.02, "kg"), "20 g");
        assert_eq!(text(PI, "rad/s"), "30 rpm");
    }
}
