//! Load cells at their limit.

use dem_io::units::significant;

/// Fewest rows at the largest force that show a limit.
const FEWEST_ROWS: usize = 5;
/// Smallest rise before the limit, over as many rows as lie at it, in steps of the display. At a
/// rounded top, n rows within one step of it follow n rows that rise by 8 steps, and by 11 of 5
/// rows: the force falls short of the top with the square of the distance from it.
const STEPS: f64 = 12.0;
/// Smallest slope there, as a fraction of the stiffness: a specimen that yields comes to its
/// largest force gently.
const STEEP: f64 = 0.25;
/// The rise counts from this fraction of the largest force on.
const LOADED: f64 = 0.5;

/// Says that the force, N, over the travel, m, stays at exactly its largest value although it was
/// rising steeply and the travel goes on. `lines`: line of each row in its file. The stiffness is
/// in N/m. None: it does not.
pub(crate) fn clipped(
    travel_m: &[f64],
    force_n: &[f64],
    lines: &[usize],
    stiffness_n_m: f64,
) -> Option<String> {
    let most_n = force_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let runs = force_n.chunk_by(|a, b| a == b);
    let mut end = 0;
    let ends = runs.map(|run| {
        end += run.len();
        (run.len(), end)
    });
    let (count, end) = (ends.filter(|(_, end)| force_n[end - 1] == most_n))
        .max_by_key(|(count, end)| (*count, usize::MAX - end))?;
    let first = end - count;
    let low = force_n[..first]
        .iter()
        .rposition(|force| *force < LOADED * most_n)?;
    let before = low.max(first.saturating_sub(count));
    if count < FEWEST_ROWS {
        return None;
    }
    let rise_n = most_n - force_n[before];
    let way_m = travel_m[first] - travel_m[before];
    let goes_on_m = travel_m[end - 1] - travel_m[first];
    let steps = force_n.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let step_n = steps
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    let is_clipped = rise_n >= STEPS * step_n
        && rise_n >= STEEP * stiffness_n_m * way_m
        && goes_on_m >= 0.5 * way_m
        && way_m > 0.0;
    is_clipped.then(|| {
        let [one, other] = [lines[first], lines[end - 1]];
        format!(
            "its load cell is at its limit: the force was rising and stays at exactly {} N (lines {} to {}) while the travel goes on by {:.3} mm; the strength is at least this: measure with a cell of larger range",
            significant(most_n, 5),
            one.min(other),
            one.max(other),
            1e3 * goes_on_m
        )
    })
}
