//! Least squares.

/// A straight line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Rise per unit of x.
    pub slope: f64,
    /// Standard error of the slope.
    pub slope_error: f64,
    /// Value at `x0`.
    pub at_x0: f64,
    /// Mean of all x.
    pub x0: f64,
    /// Standard deviation of the residuals.
    pub residual: f64,
}

impl Line {
    /// The line fitted to points; at least three, not all with the same x.
    pub fn fitted(x: &[f64], y: &[f64]) -> Self {
        let count = x.len() as f64;
        let (x0, y0) = (mean(x), mean(y));
        let pairs = || x.iter().zip(y).map(|(x, y)| (x - x0, y - y0));
        let xx: f64 = pairs().map(|(x, _)| x * x).sum();
        let xy: f64 = pairs().map(|(x, y)| x * y).sum();
        let slope = xy / xx;
        let squares: f64 = pairs().map(|(x, y)| (y - slope * x).powi(2)).sum();
        let residual = (squares / (count - 2.0).max(1.0)).sqrt();
        Self {
            slope,
            slope_error: residual / xx.sqrt(),
            at_x0: y0,
            x0,
            residual,
        }
    }

    /// The x at which its value is 0.
    pub fn zero(&self) -> f64 {
        self.x0 - self.at_x0 / self.slope
    }

    /// Its value at x.
    pub fn at(&self, x: f64) -> f64 {
        self.at_x0 + self.slope * (x - self.x0)
    }
}

/// Mean of values; at least one.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Median of values; at least one.
pub(crate) fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let half = sorted.len() / 2;
    if sorted.len() % 2 == 1 {
        sorted[half]
    } else {
        f64::midpoint(sorted[half - 1], sorted[half])
    }
}

/// Standard deviation of the noise, from second differences, which leave out everything smooth. At
/// least a ten-thousandth of the range; 0 for fewer than three values.
pub(crate) fn noise(force_n: &[f64]) -> f64 {
    if force_n.len() < 3 {
        return 0.0;
    }
    let bends: Vec<f64> = force_n
        .windows(3)
        .map(|f| (f[0] - 2.0 * f[1] + f[2]).abs())
        .collect();
    let most = force_n
        .iter()
        .fold(f64::NEG_INFINITY, |most, f| most.max(*f));
    let least = force_n.iter().fold(f64::INFINITY, |least, f| least.min(*f));
    let of_normal = 0.674_489_750_196_081_7 * 6.0_f64.sqrt();
    (median(&bends) / of_normal).max(1e-4 * (most - least))
}
