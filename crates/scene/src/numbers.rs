//! Numbers as shown in the listing of a scene.

use dem_io::text::exact;

/// A number with at most 12 digits, which hides the rounding of units.
pub(super) fn number(number: f64) -> String {
    let rounded: f64 = format!("{number:.11e}").parse().unwrap_or(number);
    exact(rounded)
}

/// `text` and the unit, if there is one.
pub(super) fn with_unit(text: &str, unit: &str) -> String {
    format!("{text} {unit}").trim_end().to_owned()
}

pub(super) fn quantity(of: f64, unit: &str) -> String {
    with_unit(&number(of), unit)
}

pub(super) fn vector(components: [f64; 3], unit: &str) -> String {
    let listed = components.map(number).join(", ");
    with_unit(&format!("[{listed}]"), unit)
}
