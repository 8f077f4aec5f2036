//! Values of the summary, and numbers as words.

use dem_io::units::significant;
use serde_json::Value;

pub(super) fn text(value: &Value) -> &str {
    value.as_str().unwrap_or_default()
}

pub(super) fn texts(value: &Value) -> Vec<String> {
    let all = value.as_array().into_iter().flatten();
    all.map(|value| text(value).to_owned()).collect()
}

/// NaN of what is no number.
pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

pub(super) fn percent(fraction: f64) -> String {
    format!("{} %", significant(100.0 * fraction, 3))
}
