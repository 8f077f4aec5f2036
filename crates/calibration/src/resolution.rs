//! Error of the resolution: the curves of several sizes of spheres, each with its own bonds.

use dem_io::interpolation::interpolated;
use dem_laboratory::area_between;

use crate::case::{Case, Round};
use crate::record::Record;

/// Points of a mean curve.
const POINTS: usize = 101;

/// The mean of the curves of a round, up to the mean displacement at the largest load: loads are
/// averaged at equal fractions of that displacement, as for measured curves. Displacement, m, and
/// load, N. Length 101, or 0 without curves.
pub(crate) fn mean_curve(round: &Round) -> Vec<[f64; 2]> {
    let curves: Vec<&[[f64; 2]]> = round
        .trials
        .iter()
        .flatten()
        .map(|trial| up_to_peak(&trial.curve))
        .filter(|curve| curve.len() > 1)
        .collect();
    if curves.is_empty() {
        return Vec::new();
    }
    let count = curves.len() as f64;
    let point = |at: usize| {
        let fraction = at as f64 / (POINTS - 1) as f64;
        let sum = curves.iter().fold([0.0; 2], |[x, y], curve| {
            let displacement_m = fraction * curve[curve.len() - 1][0];
            let load_n = interpolated(curve, displacement_m).unwrap_or(0.0);
            [x + displacement_m, y + load_n]
        });
        sum.map(|sum| sum / count)
    };
    (0..POINTS).map(point).collect()
}

/// A curve up to its largest load.
fn up_to_peak(curve: &[[f64; 2]]) -> &[[f64; 2]] {
    let rows = curve.iter().enumerate();
    let peak = rows.max_by(|(_, a), (_, b)| a[1].total_cmp(&b[1]));
    peak.map_or(&[], |(at, _)| &curve[..=at])
}

/// Area between the mean curve of a case and the wanted one, or else that of the finest case, over
/// the area below that one. None: there is nothing to compare with.
pub fn curve_error(record: &Record, case: &Case) -> Option<f64> {
    let own = mean_curve(case.result()?);
    let finest = record.cases.last()?;
    let wanted = match record.wanted_curve.as_slice() {
        [] if std::ptr::eq(finest, case) || !finest.is_met() => return None,
        [] => mean_curve(finest.result()?),
        wanted => wanted.to_vec(),
    };
    (!own.is_empty() && !wanted.is_empty()).then(|| area_between(&own, &wanted))
}

/// The coarsest case that has met its targets and whose curve is at most `most` away from the
/// wanted one.
pub fn coarsest(record: &Record, most: f64) -> Option<&Case> {
    let is_near = |case: &&Case| curve_error(record, case).is_some_and(|error| error <= most);
    record
        .cases
        .iter()
        .filter(|case| case.is_met())
        .find(is_near)
}
