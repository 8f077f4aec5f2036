//! Percentages as text.

use dem_io::units::significant;

pub(super) fn percent(fraction: f64) -> String {
    format!("{} %", significant(100.0 * fraction, 3))
}
