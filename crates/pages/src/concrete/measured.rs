//! Load over opening: what is compared, and the measured bands of `tests/concrete/measured.csv`.

use crate::bench::{Failed, root};

/// The beams of the file.
pub(crate) const MEASURED: [&str; 2] = ["half-notched", "mixed mode"];
/// Openings at which loads are compared, m; up to the last one the work is.
pub(crate) const OPENINGS_M: [f64; 3] = [20e-6, 50e-6, 100e-6];
/// Opening at which the stiffness is, m.
const EARLY_M: f64 = 10e-6;

/// The measured band of a beam.
pub(crate) struct Measured {
    pub(crate) beam: String,
    /// Opening, m, and the ends of the band there, N.
    pub(crate) rows: Vec<[f64; 3]>,
}

/// Reads the band of a beam.
pub(crate) fn measured(beam: &str) -> Result<Measured, Failed> {
    let text = std::fs::read_to_string(root().join("tests/concrete/measured.csv"))?;
    let mut rows = Vec::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.split(',').collect();
        if let [name, opening_mm, low_n, high_n] = cells[..]
            && name == beam
        {
            let opening_m = 1e-3 * opening_mm.parse::<f64>()?;
            rows.push([opening_m, low_n.parse()?, high_n.parse()?]);
        }
    }
    if rows.is_empty() {
        return Err(format!("tests/concrete/measured.csv has no {beam}").into());
    }
    Ok(Measured {
        beam: beam.to_owned(),
        rows,
    })
}

impl Measured {
    /// The smaller and the larger of the numbers of both ends of the band.
    pub(crate) fn loads(&self) -> [[f64; 2]; 7] {
        let [low, high] = [1, 2].map(|end| {
            let points: Vec<[f64; 2]> = self.rows.iter().map(|row| [row[0], row[end]]).collect();
            Load::of(&points).numbers()
        });
        std::array::from_fn(|at| [low[at].min(high[at]), low[at].max(high[at])])
    }
}

/// What is compared of a curve of load over opening.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Load([f64; 7]);

impl Load {
    /// Places in `numbers`: largest load, N, and its opening, um; load at each of the openings, N;
    /// work of the load on the opening up to the last, mJ; behind what the table shows, the load at
    /// the early opening, N.
    pub(crate) const LARGEST: usize = 0;
    pub(crate) const OPENING: usize = 1;
    pub(crate) const AT: [usize; 3] = [2, 3, 4];
    pub(crate) const WORK: usize = 5;
    pub(crate) const EARLY: usize = 6;

    /// Of points of opening, m, and load, N.
    pub(crate) fn of(points: &[[f64; 2]]) -> Self {
        let larger = |a: [f64; 2], b: &[f64; 2]| if b[1] > a[1] { *b } else { a };
        let [at_m, largest_n] = points.iter().fold([0.0; 2], larger);
        let [first_n, second_n, third_n] = OPENINGS_M.map(|m| load_at(points, m));
        let mut work_j = 0.0;
        for pair in points.windows(2) {
            if pair[1][0] <= OPENINGS_M[2] {
                work_j += 0.5 * (pair[0][1] + pair[1][1]) * (pair[1][0] - pair[0][0]);
            }
        }
        Self([
            largest_n,
            1e6 * at_m,
            first_n,
            second_n,
            third_n,
            1e3 * work_j,
            load_at(points, EARLY_M),
        ])
    }

    pub(crate) fn numbers(self) -> [f64; 7] {
        self.0
    }
}

/// The load where the opening is reached first, N. NaN: it is not.
fn load_at(points: &[[f64; 2]], opening_m: f64) -> f64 {
    let reached = points.windows(2).find(|pair| pair[1][0] >= opening_m);
    reached.map_or(f64::NAN, |pair| {
        let part = (opening_m - pair[0][0]) / (pair[1][0] - pair[0][0]);
        pair[0][1] + part * (pair[1][1] - pair[0][1])
    })
}
