//! Names with their unit and numbers, on plots and in tables.

use dem_io::units::significant;

/// `name (unit)`.
pub(crate) fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} ({unit})")
    }
}

/// A number with these digits, or nothing.
pub(crate) fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or(String::new(), |value| significant(value, digits))
}
