//! How far and how long a test of a calibration goes.

/// Stroke over the travel at failure that strong packings need.
const ROOM: f64 = 1.6;

/// `--set` values with which the stroke is long enough for a body that fails at this travel, m, and
/// the periods of the test, where they set its rate, are spread over that travel, not over the
/// stroke. A body of spheres of this mean diameter, m, may rock by as much until all pins touch.
pub fn pace(
    stroke_m: f64,
    periods: Option<f64>,
    travel_m: f64,
    mean_diameter_m: f64,
) -> Vec<String> {
    let stroke_m = stroke_m.max(ROOM * travel_m + mean_diameter_m);
    let mut sets = vec![format!("test.stroke={stroke_m:e}")];
    if let Some(periods) = periods {
        sets.push(format!(
            "test.periods={:.4e}",
            periods * stroke_m / travel_m
        ));
    }
    sets
}
