//! Force over travel of a made-up laboratory test: offset and drift of the load cell, seating, a
//! straight part, a bend before the largest force, a tail, noise.

use dem_io::random::uniform;

/// Numbers of a made-up test.
#[derive(Debug, Clone, Copy)]
pub struct Made {
    /// Slope of the straight part, N/m.
    pub stiffness_n_m: f64,
    /// Largest force, N.
    pub failure_n: f64,
    /// Travel before contact, m.
    pub before_m: f64,
    /// Length of the seating, over which the force rises with the square of the travel, m.
    pub seating_m: f64,
    /// Offset, N.
    pub offset_n: f64,
    /// Drift over the entire test, N.
    pub drift_n: f64,
    /// Standard deviation of the noise, N.
    pub noise_n: f64,
    /// Fraction of the largest force above which the curve bends.
    pub bend: f64,
    /// Force behind the failure, as a fraction of the largest.
    pub tail: f64,
    /// Number of rows.
    pub rows: usize,
    /// Seed of the noise.
    pub seed: u64,
}

/// About the sample of Platzer 2022, 4.5.1.2.
pub const USUAL: Made = Made {
    stiffness_n_m: 18_230.0,
    failure_n: 51.45,
    before_m: 0.5e-3,
    seating_m: 0.3e-3,
    offset_n: 1.7,
    drift_n: 0.5,
    noise_n: 0.1,
    bend: 0.8,
    tail: 0.0,
    rows: 1200,
    seed: 1,
};

/// The normally distributed number of a row.
fn normal(seed: u64, row: usize) -> f64 {
    let [u, v]: [f64; 2] = [0, 1].map(|word| uniform(seed, &[row as u64, word]));
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

impl Made {
    /// Travel from contact at which the force is largest, m.
    fn failure_m(&self) -> f64 {
        let straight = self.bend * self.failure_n / self.stiffness_n_m;
        let bent = 2.0 * (1.0 - self.bend) * self.failure_n / self.stiffness_n_m;
        0.5 * self.seating_m + straight + bent
    }

    /// Force at a travel from contact: k x^2/(2 s) up to s, then a line, then a parabola that is
    /// level at the largest force, then a tail.
    fn force_n(&self, x: f64) -> f64 {
        let k = self.stiffness_n_m;
        if x <= 0.0 {
            return 0.0;
        }
        if x > self.failure_m() {
            return self.tail * self.failure_n;
        }
        if x < self.seating_m {
            return 0.5 * k * x * x / self.seating_m;
        }
        let line = k * (x - 0.5 * self.seating_m);
        let bend_n = self.bend * self.failure_n;
        if line <= bend_n {
            return line;
        }
        let over = (line - bend_n) / k;
        let length = 2.0 * (1.0 - self.bend) * self.failure_n / k;
        bend_n + k * over - 0.5 * k * over * over / length
    }

    /// Travel at the end of the test, m.
    pub fn end_m(&self) -> f64 {
        self.before_m + 1.25 * self.failure_m()
    }

    /// Travel, m, and force, N.
    pub fn rows(&self) -> (Vec<f64>, Vec<f64>) {
        let end_m = self.end_m();
        (0..self.rows)
            .map(|row| {
                let x = end_m * row as f64 / (self.rows - 1) as f64;
                let drift = self.offset_n + self.drift_n * x / end_m;
                let noise = self.noise_n * normal(self.seed, row);
                (x, drift + noise + self.force_n(x - self.before_m))
            })
            .unzip()
    }
}
