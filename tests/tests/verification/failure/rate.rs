//! Strength at a constant strain rate.

use super::bond::{Criterion, LENGTH_M, STRAIN, TENSION_PA, YOUNG_PA, bond, breaks_s};
use crate::verification::table::{Case, compared};

/// The dynamic increase factor of Platzer 2022, eq. 20.
pub(crate) fn dynamic_increase_factor(rate_1_s: f64) -> f64 {
    let lg = rate_1_s.clamp(4.64e-6, 50.0).log10();
    if rate_1_s <= 0.1 {
        (1.0 + 0.0225 * (lg + 5.3333)).max(1.0)
    } else {
        1.6 + 1.235 * lg + 0.7325 * lg * lg
    }
}

/// Number of steps until the static strength is reached, such that at no rate a bond breaks just at
/// the end of a step, where rounding decides.
const STATIC_STEPS: f64 = 5066.7;

/// Strength over static strength of a bond under a constant strain rate.
fn strengthened(rate_1_s: f64, from_1_s: f64) -> f64 {
    let static_s = TENSION_PA / YOUNG_PA / rate_1_s;
    let half = 0.5 * rate_1_s * LENGTH_M;
    let more = format!(
        r#"
        supports.left = {{ group = "left", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = {:e} }} }}
        supports.right = {{ group = "right", fixed = ["y", "z", "rx", "ry", "rz"], velocity = {{ x = {half:e} }} }}
        "#,
        -half
    );
    let failure = format!(
        "{}, rate_strengthening = {from_1_s:e}",
        Criterion::Tension.key()
    );
    let end_s = 8.0 * static_s;
    let run = format!(
        "end_time = {end_s:e}, time_step = {:e}",
        static_s / STATIC_STEPS
    );
    breaks_s(&mut bond(&failure, &run, &more), end_s) / static_s
}

pub(crate) fn by_rate() -> [String; 2] {
    let rates = [1e-6, 1e-5, 1e-3, 0.1, 0.2, 1.0, 1.2, 10.0, 50.0, 100.0];
    let [all, from] = [1e-9, 1.1].map(|from| {
        let cases = rates.map(|rate| {
            let wanted = if rate < from {
                1.0
            } else {
                dynamic_increase_factor(rate)
            };
            let bound = 1.0 / STATIC_STEPS + STRAIN;
            Case::new(format!("{rate}"), strengthened(rate, from), wanted, bound)
        });
        compared("rate, 1/s", "", &cases)
    });
    [all, from]
}
