//! Long lines with no more points than can be seen.

/// Lines of up to this many points are drawn as they are.
const DRAWN_POINTS: usize = 1000;
/// Columns of a long line: two points each.
const COLUMNS: usize = 480;

/// The pieces of a line between its gaps (None), thinned so that it looks the same: of the points that share a narrow column,
/// the lowest and the highest are kept.
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
    let (low, high) = xs().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    if xs().is_sorted() {
        let columns = COLUMNS as f64 / (high - low).max(f64::MIN_POSITIVE);
        by_column(points, |_, point| ((point[0] - low) * columns) as usize)
    } else {
        // A curve that turns back: as many points in a row share a column as there are for each.
        let in_a_row = points.len().div_ceil(COLUMNS);
        by_column(points, |index, _| index / in_a_row)
    }
}

/// Of each run of points in one column the lowest and the highest, in their order. Gaps within a column cannot be seen.
fn by_column(
    points: &[Option<[f64; 2]>],
    column: impl Fn(usize, [f64; 2]) -> usize,
) -> Vec<Option<[f64; 2]>> {
    let mut kept = Vec::new();
    let mut run: Option<Run> = None;
    let mut gap = false;
    for (index, point) in points.iter().enumerate() {
        let Some(point) = *point else {
            gap = true;
            continue;
        };
        let now = column(index, point);
        match &mut run {
            Some(run) if run.column == now => run.add(index, point),
            other => {
                if let Some(run) = other.replace(Run::new(now, index, point)) {
                    run.keep(&mut kept);
                    if gap {
                        kept.push(None);
                    }
                }
            }
        }
        gap = false;
    }
    if let Some(run) = run {
        run.keep(&mut kept);
    }
    kept
}

/// Points in a row that share a column.
struct Run {
    column: usize,
    low: (usize, [f64; 2]),
    high: (usize, [f64; 2]),
}

impl Run {
    fn new(column: usize, index: usize, point: [f64; 2]) -> Self {
        Self {
            column,
            low: (index, point),
            high: (index, point),
        }
    }

    fn add(&mut self, index: usize, point: [f64; 2]) {
        if point[1] < self.low.1[1] {
            self.low = (index, point);
        }
        if point[1] > self.high.1[1] {
            self.high = (index, point);
        }
    }

    fn keep(self, kept: &mut Vec<Option<[f64; 2]>>) {
        let (first, last) = if self.low.0 <= self.high.0 {
            (self.low, self.high)
        } else {
            (self.high, self.low)
        };
        kept.push(Some(first.1));
        if last.0 != first.0 {
            kept.push(Some(last.1));
        }
    }
}
