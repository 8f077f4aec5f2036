//! Bodies with few particles across: their results depend on the particles.

use crate::units::{show_length, significant};

/// Number of particles across the thinnest part below which the result reflects the particles
/// rather than the material.
pub const ENOUGH_ACROSS: f64 = 10.0;

/// A sentence on a body with few particles across, with advice. `part`: what has this thickness,
/// m. None: there are enough.
pub fn few_across(particles_across: f64, part: &str, thickness_m: f64) -> Option<String> {
    (particles_across.round() < ENOUGH_ACROSS).then(|| {
        format!(
            "only about {} particles across {part} ({}): with fewer than {ENOUGH_ACROSS} the result reflects the particles rather than the material; use diameters around {} or less",
            significant(particles_across, 2),
            show_length(thickness_m),
            show_length(significant_down(thickness_m / ENOUGH_ACROSS)),
        )
    })
}

/// Rounded down to two digits.
fn significant_down(value: f64) -> f64 {
    if value <= 0.0 {
        return 0.0;
    }
    let step = 10.0_f64.powf(value.log10().floor() - 1.0);
    (value / step * (1.0 + 1e-12)).floor() * step
}
