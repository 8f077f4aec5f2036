//! Changes one at a time: each parameter from the base to the ends of its range, all others at the
//! base.

use dem_laboratory::Statistic;
use serde::Serialize;

use dem_laboratory::student_95;

/// The points of the design, as the index of the value of each parameter: the base, then each
/// parameter at its other values in turn. `bases` and `values`: for each parameter the index of
/// its base, and the number of its values.
pub fn points(bases: &[usize], values: &[usize]) -> Vec<Vec<usize>> {
    let mut points = vec![bases.to_vec()];
    for (parameter, (base, count)) in bases.iter().zip(values).enumerate() {
        for value in (0..*count).filter(|value| value != base) {
            let mut point = bases.to_vec();
            point[parameter] = value;
            points.push(point);
        }
    }
    points
}

/// What a change of one parameter changes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Change {
    /// Change of the value, in its unit: the mean over the seeds that have both values.
    pub change: f64,
    /// Half the width of its 95 % confidence interval by chance (Student's t of the differences,
    /// seed by seed). None for a single seed.
    pub half_width: Option<f64>,
    /// Number of these seeds.
    pub seeds: usize,
}

impl Change {
    /// From the values at the base and at the other point, seed by seed. None: no seed has both.
    pub fn of(base: &[Option<f64>], other: &[Option<f64>]) -> Option<Self> {
        let both = base.iter().zip(other);
        let changes: Vec<f64> = both.filter_map(|(a, b)| Some((*b)? - (*a)?)).collect();
        let statistic = Statistic::of(&changes);
        let seeds = changes.len();
        (seeds > 0).then(|| Self {
            change: statistic.mean,
            half_width: (seeds > 1).then(|| {
                student_95(seeds - 1) * statistic.standard_deviation / (seeds as f64).sqrt()
            }),
            seeds,
        })
    }

    /// Whether the change is more than chance, with a confidence of 95 %. None: that is not known.
    pub fn is_above_chance(&self) -> Option<bool> {
        self.half_width.map(|half| self.change.abs() > half)
    }
}

/// d ln y/d ln x between two points `[x, y]`, by how many per cent y changes where x changes by
/// one. None: a logarithm does not exist.
pub fn elasticity([x, y]: [f64; 2], [other_x, other_y]: [f64; 2]) -> Option<f64> {
    let [of_x, of_y] = [other_x / x, other_y / y];
    let is_meaningful = x > 0.0 && other_x > 0.0 && of_x != 1.0 && of_y > 0.0 && of_y.is_finite();
    is_meaningful.then(|| of_y.ln() / of_x.ln())
}
