//! Thinning of long lines to the visible points.

/// Lines up to this number of points are drawn unchanged.
const DRAWN_POINTS: usize = 1000;
/// Number of columns of a long line: two points each.
const COLUMNS: usize = 480;

/// The pieces of a line between its gaps (None), thinned so that it looks the same: of the points
/// in a narrow column, the lowest and the highest are kept.
pub(crate) fn segments(points: impl Iterator<Item = Option<[f64; 2]>>) -> Vec<Vec<[f64; 2]>> {
    let mut points: Vec<Option<[f64; 2]>> = points.collect();
    if points.len() > DRAWN_POINTS {
        points = thinned(&points);
    }
    points
        .split(Option::is_none)
        .filter(|piece| !piece.is_empty())
        .map(|piece| piece.iter().copied().flatten().collect())
        .collect()
}

fn thinned(points: &[Option<[f64; 2]>]) -> Vec<Option<[f64; 2]>> {
    let xs = || points.iter().flatten().map(|point| point[0]);
    let low = xs().fold(f64::INFINITY, f64::min);
    let width = (xs().fold(f64::NEG_INFINITY, f64::max) - low).max(f64::MIN_POSITIVE);
    // A curve that turns back: a number of successive points, the average for each column, share a
    // column.
    let (is_rising, in_a_row) = (xs().is_sorted(), points.len().div_ceil(COLUMNS));
    let column = |index: usize, [x, _]: [f64; 2]| match is_rising {
        true => ((x - low) * COLUMNS as f64 / width) as usize,
        false => index / in_a_row,
    };
    let placed = |(index, point): (usize, &Option<[f64; 2]>)| {
        point.map(|point| (column(index, point), index, point))
    };
    let placed: Vec<_> = points.iter().enumerate().filter_map(placed).collect();
    let mut kept = Vec::new();
    let mut next = 0;
    for shared in placed.chunk_by(|a, b| a.0 == b.0) {
        // Gaps within a column are invisible.
        if shared[0].1 > next {
            kept.push(None);
        }
        let heights = || shared.iter().map(|(_, index, [_, y])| (*y, *index));
        let lowest = heights().min_by(|a, b| a.0.total_cmp(&b.0));
        let highest = heights().rev().max_by(|a, b| a.0.total_cmp(&b.0));
        let mut both = [lowest, highest].map(|one| one.map_or(0, |(_, index)| index));
        both.sort_unstable();
        let count = if both[0] == both[1] { 1 } else { 2 };
        kept.extend(both[..count].iter().map(|index| points[*index]));
        next = shared[shared.len() - 1].1 + 1;
    }
    kept
}
