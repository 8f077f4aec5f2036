//! Neighbour search among spheres: points sorted into cubic cells.

/// Points in cubic cells, sorted by cell and then by index, so that the order of results never
/// changes.
///
/// All cells have the same size: suitable for radii that differ by a factor of some tens at most.
pub(super) struct Cells {
    edge_m: f64,
    low_m: [f64; 3],
    sorted: Vec<([i64; 3], u32)>,
}

impl Cells {
    /// Sorts points, m, into cells with edges of `edge_m`, m, or of 1 m if that is not a positive
    /// number.
    pub(super) fn new(points_m: &[[f64; 3]], edge_m: f64) -> Self {
        let edge_m = if edge_m > 0.0 { edge_m } else { 1.0 };
        let low_m = points_m.iter().fold([f64::INFINITY; 3], |low, p| {
            [0, 1, 2].map(|a| p[a].min(low[a]))
        });
        let mut cells = Self {
            edge_m,
            low_m,
            sorted: Vec::new(),
        };
        cells.sorted = (0_u32..)
            .zip(points_m)
            .map(|(i, p)| (cells.cell(p), i))
            .collect();
        cells.sorted.sort_unstable();
        cells
    }

    /// Puts into `found` the indices of all points in the cell of `point_m` and the 26 cells around
    /// it: all points within one edge, and some more distant ones.
    pub(super) fn near(&self, point_m: &[f64; 3], found: &mut Vec<u32>) {
        found.clear();
        let [x, y, z] = self.cell(point_m);
        for cx in x.saturating_sub(1)..=x.saturating_add(1) {
            for cy in y.saturating_sub(1)..=y.saturating_add(1) {
                let first = ([cx, cy, z.saturating_sub(1)], 0);
                let last = [cx, cy, z.saturating_add(1)];
                let start = self.sorted.partition_point(|entry| *entry < first);
                let column = self.sorted[start..].iter();
                found.extend(
                    column
                        .take_while(|entry| entry.0 <= last)
                        .map(|entry| entry.1),
                );
            }
        }
    }

    fn cell(&self, point_m: &[f64; 3]) -> [i64; 3] {
        [0, 1, 2].map(|a| ((point_m[a] - self.low_m[a]) / self.edge_m) as i64)
    }
}
