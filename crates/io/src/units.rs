//! Numbers with units, as people write them: "2 mm", "2.05 g/cm3". Inside the program everything is SI.

use crate::{Diagnostic, Result};

/// Units of length and their size in metres.
pub const LENGTH_UNITS: [(&str, f64); 7] = [
    ("nm", 1e-9),
    ("um", 1e-6),
    ("mm", 1e-3),
    ("cm", 1e-2),
    ("m", 1.0),
    ("km", 1e3),
    ("in", 0.0254),
];

/// Units of density and their size in kg/m3.
pub const DENSITY_UNITS: [(&str, f64); 3] = [("kg/m3", 1.0), ("g/cm3", 1e3), ("t/m3", 1e3)];

/// A length in metres from "2mm", "2 mm" or a plain number of metres.
///
/// # Errors
/// Not a number, not finite, or an unknown unit.
pub fn length_m(text: &str) -> Result<f64> {
    quantity(text, &LENGTH_UNITS, "length", "2mm")
}

/// A density in kg/m3 from "2.05 g/cm3" or a plain number of kg/m3.
///
/// # Errors
/// Not a number, not finite, or an unknown unit.
pub fn density_kg_m3(text: &str) -> Result<f64> {
    quantity(text, &DENSITY_UNITS, "density", "2050kg/m3")
}

/// Metres in one unit of length, from its name.
///
/// # Errors
/// An unknown unit.
pub fn length_unit_m(name: &str) -> Result<f64> {
    unit_size(name.trim(), &LENGTH_UNITS)
}

fn quantity(text: &str, units: &[(&str, f64)], what: &str, example: &str) -> Result<f64> {
    let text = text.trim();
    let number_end = number_length(text);
    let (number, unit) = text.split_at(number_end);
    let value: f64 = number.parse().map_err(|_| {
        Diagnostic::input(
            "",
            format!("'{text}' is not a {what}"),
            format!("write a number with a unit, such as {example}"),
        )
    })?;
    let unit = unit.trim();
    let size = if unit.is_empty() {
        1.0
    } else {
        unit_size(unit, units)?
    };
    let value = value * size;
    if !value.is_finite() {
        return Err(Diagnostic::input(
            "",
            format!("'{text}' is not a finite {what}"),
            "",
        ));
    }
    Ok(value)
}

/// Length in bytes of the number that `text` begins with.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    while end < bytes.len() {
        let c = bytes[end];
        let exponent = matches!(c, b'e' | b'E')
            && end > 0
            && bytes
                .get(end + 1)
                .is_some_and(|n| n.is_ascii_digit() || matches!(n, b'+' | b'-'));
        let sign = matches!(c, b'+' | b'-') && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        if !(c.is_ascii_digit() || c == b'.' || exponent || sign) {
            break;
        }
        end += 1;
    }
    end
}

fn unit_size(name: &str, units: &[(&str, f64)]) -> Result<f64> {
    let name = name.replace('µ', "u").replace('³', "3").replace('^', "");
    units
        .iter()
        .find(|(known, _)| *known == name)
        .map(|(_, size)| *size)
        .ok_or_else(|| {
            let known: Vec<&str> = units.iter().map(|(n, _)| *n).collect();
            Diagnostic::input(
                "",
                format!("unknown unit '{name}'"),
                format!("use one of {}", known.join(", ")),
            )
        })
}

/// A length for a person: three to four digits in the unit that suits its size.
pub fn show_length(metres: f64) -> String {
    let size = metres.abs();
    let (name, unit) = match size {
        s if s == 0.0 || s >= 1.0 => ("m", 1.0),
        s if s >= 1e-4 => ("mm", 1e-3),
        s if s >= 1e-7 => ("um", 1e-6),
        _ => ("nm", 1e-9),
    };
    format!("{} {name}", significant(metres / unit, 4))
}

/// `value` with so many significant digits, without trailing zeros.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = value.abs().log10().floor() as i32;
    if !(-4..=9).contains(&magnitude) {
        return format!("{value:.*e}", digits - 1);
    }
    let decimals = (digits as i32 - 1 - magnitude).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_with_and_without_units() {
        assert_eq!(length_m("2mm").ok(), Some(2e-3));
        assert_eq!(length_m(" 2.5e-3 m").ok(), Some(2.5e-3));
        assert_eq!(length_m("0.002").ok(), Some(0.002));
        assert_eq!(length_m("3µm").ok(), Some(3.0 * 1e-6));
        assert_eq!(density_kg_m3("2.05 g/cm3").ok(), Some(2.05 * 1e3));
        for bad in ["", "mm", "2 parsec", "nan", "1e999", "2mm3", "--2"] {
            assert!(length_m(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_for_a_person() {
        assert_eq!(show_length(0.0025), "2.5 mm");
        assert_eq!(show_length(3.2e-6), "3.2 um");
        assert_eq!(significant(77487.0, 4), "77487");
        assert_eq!(significant(0.597_12, 3), "0.597");
    }
}
