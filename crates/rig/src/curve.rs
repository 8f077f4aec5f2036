//! The curve of a test: its means, its elastic part and its peak.

use dem_laboratory::{ELASTIC, FALL, elastic_line, elastic_rows, largest_force};

use super::record::{Record, Row};

/// Time over which loads are averaged, in periods of the lowest frequency.
const WINDOW: f64 = 0.05;

/// Ratio of load to displacement in the elastic part of a test.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// N/m.
    pub stiffness_n_m: f64,
    /// Displacement at which the fitted line has no load: play until everything touches, m.
    pub start_m: f64,
}

/// The rows used in the evaluation of a test: means over a twentieth of the lowest period, which
/// remove faster oscillations.
pub fn rows_of(record: &Record, lowest_frequency_hz: f64) -> Vec<Row> {
    record.smoothed(WINDOW / lowest_frequency_hz)
}

/// The slope of the load over a displacement `way`, by least squares, between 20 % and 60 % of
/// `wanted_n`, the load of a body with the wanted strength, if the largest load reaches 60 % of it,
/// or else of the largest load. None: too few rows.
pub fn slope(rows: &[Row], wanted_n: Option<f64>, way: impl Fn(&Row) -> f64) -> Option<Slope> {
    let (ways_m, loads_n): (Vec<f64>, Vec<f64>) =
        rows.iter().map(|row| (way(row), row.load_n())).unzip();
    let largest_n = largest_n(rows)?;
    let reached_n = wanted_n.filter(|wanted_n| largest_n >= ELASTIC[1] * wanted_n);
    let line = elastic_line(&ways_m, &loads_n, reached_n.unwrap_or(largest_n))?;
    Some(Slope {
        stiffness_n_m: line.slope,
        start_m: line.zero(),
    })
}

/// The rows between 20 % and 60 % of the largest load. None: too few for a slope.
pub(super) fn elastic_range(rows: &[Row]) -> Option<&[Row]> {
    let loads_n: Vec<f64> = rows.iter().map(Row::load_n).collect();
    let elastic = elastic_rows(&loads_n, largest_n(rows)?)?;
    Some(&rows[elastic])
}

/// Travel at which the line fitted to the load over the travel has no load, m: play until
/// everything touches. 0 without a line.
pub(crate) fn play_m(rows: &[Row]) -> f64 {
    slope(rows, None, |row| row.travel_m).map_or(0.0, |slope| slope.start_m)
}

/// The largest load, N, by the rule for measured curves. None: no rows.
pub fn largest_n(rows: &[Row]) -> Option<f64> {
    let (ways_m, loads_n): (Vec<f64>, Vec<f64>) =
        rows.iter().map(|row| (row.travel_m, row.load_n())).unzip();
    Some(largest_force(&ways_m, &loads_n)?.force_n)
}

/// The row with the largest load.
pub fn peak(rows: &[Row]) -> Option<&Row> {
    rows.iter().max_by(|a, b| a.load_n().total_cmp(&b.load_n()))
}

/// The peak that comes before the largest load and the lowest load between them, N, if the load
/// falls by as much between them as tells two peaks of a measured curve. None: it does not.
pub(crate) fn earlier_peak(rows: &[Row]) -> Option<[f64; 2]> {
    let largest_n = peak(rows)?.load_n();
    let [mut before_n, mut high_n] = [f64::NEG_INFINITY; 2];
    let mut low_n = f64::INFINITY;
    for row in rows {
        let load_n = row.load_n();
        if load_n >= largest_n {
            break;
        }
        if load_n > high_n {
            high_n = load_n;
        } else if high_n - load_n > (before_n - low_n).max(FALL * largest_n) {
            [before_n, low_n] = [high_n, load_n];
        }
    }
    (low_n < before_n).then_some([before_n, low_n])
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic)]
    use dem_laboratory::{Curve, Regions};

    use super::*;

    #[test]
    fn a_peak_before_the_largest_load_is_found_by_its_fall() {
        let rows = |loads_n: &[f64]| -> Vec<Row> {
            let row = |force_n: &f64| Row {
                force_n: *force_n,
                reaction_n: *force_n,
                ..Row::default()
            };
            loads_n.iter().map(row).collect()
        };
        let found = |loads_n: &[f64]| earlier_peak(&rows(loads_n));
        assert_eq!(found(&[0.0, 80.0, 48.0, 84.0, 10.0]), Some([80.0, 48.0]));
        assert_eq!(found(&[0.0, 80.0, 70.0, 84.0, 10.0]), None);
        assert_eq!(found(&[0.0, 84.0, 48.0, 80.0, 10.0]), None);
        // The deepest fall counts, and a fall in several steps.
        let loads_n = [0.0, 40.0, 20.0, 60.0, 50.0, 30.0, 84.0];
        assert_eq!(found(&loads_n), Some([60.0, 30.0]));
        assert_eq!(found(&[0.0, 10.0, 20.0]), None);
    }

    /// A curve of a test and the same curve of a rig have the same stiffness, play and strength, to
    /// the last digit: smooth and noisy ones, straight and curved. Before contact nothing loads the
    /// cell: a noisy curve without such a part has an offset.
    #[test]
    fn simulated_and_measured_curves_have_one_rule() {
        let mut last = 7_u64;
        let mut noise = || {
            last = last.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (last >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for (power, scatter, before_m) in [
            (1.0, 0.0, 0.0),
            (1.0, 0.02, 2e-4),
            (1.5, 0.0, 2e-4),
            (1.5, 0.004, 2e-4),
            (0.6, 0.05, 2e-4),
        ] {
            let row = |n: usize| {
                let travel_m = 2e-6 * n as f64;
                let way = (travel_m - before_m) / 1.6e-3;
                let load_n = match way {
                    way if way <= 0.0 || way > 1.0 => 0.0,
                    way => 80.0 * (way.powf(power) + scatter * noise()).max(0.0),
                };
                Row {
                    travel_m,
                    force_n: load_n,
                    reaction_n: load_n,
                    ..Row::default()
                }
            };
            let rows: Vec<Row> = (0..1000).map(row).collect();
            let (ways_m, loads_n) = rows.iter().map(|row| (row.travel_m, row.force_n)).unzip();
            let curve = Curve::new(ways_m, loads_n, (1..=rows.len()).collect()).unwrap();
            let measured = Regions::of(&curve);
            let simulated = slope(&rows, None, |row| row.travel_m).unwrap();
            assert_eq!(simulated.stiffness_n_m, measured.stiffness_n_m);
            assert_eq!(simulated.start_m, measured.start_m);
            let largest_n = largest_n(&rows).unwrap();
            assert_eq!(largest_n, measured.largest_n, "{power} {scatter}");
            // Of the largest of many rows noise would make up to half of its range more.
            let off = largest_n / 80.0 - 1.0;
            assert!(off.abs() < 1e-3 + 0.2 * scatter, "{power} {scatter}: {off}");
        }
    }
}
