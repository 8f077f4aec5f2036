//! The probability of an outcome over a parameter, p = 1/(1 + exp(-(a + b x))), from runs with and
//! without the outcome.
//!
//! The fit maximises the likelihood with Firth's penalty (Firth 1993): half the logarithm of the
//! determinant of the information is added. The fit then exists also where all runs below a value
//! of x lack the outcome and all above have it, for which the likelihood has no maximum. Intervals
//! contain what the profile of the penalised likelihood does not reject (Heinze and Schemper 2002).
//! Nothing depends on the unit of x or on its origin.

use serde::Serialize;

/// Half the 95 % quantile of chi squared with one degree of freedom: a penalised log-likelihood
/// lower by this is rejected.
const REJECTED: f64 = 0.5 * 3.841_458_821;
/// Steps of Newton's method; some ten are usual.
const MOST_STEPS: usize = 200;
/// A step shorter than this, with x from 0 to 1, leads on without a look at the likelihood, whose
/// change is lost in rounding.
const SURE_STEP: f64 = 1e-4;
/// Largest change of a coefficient in a step, with x from 0 to 1.
const LONGEST_STEP: f64 = 5.0;
/// Slopes over the inverse of the smallest distance of two values: beyond, an outcome would be
/// certain at all values but one.
const STEEPEST: f64 = 60.0;
/// Slopes that are tried for a maximum, before it is found exactly.
const TRIED: i32 = 20;
/// Ends of intervals are looked for within this many times the range of x to either side.
const FARTHEST: f64 = 16.0;
/// Halvings with which the end of an interval is found.
const HALVINGS: usize = 50;

/// The runs at one value of the parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trials {
    /// The value of the parameter.
    pub x: f64,
    /// Number of runs.
    pub runs: usize,
    /// How many of them have the outcome.
    pub with_outcome: usize,
}

/// A fitted probability over a parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Logistic {
    /// The trials, with x from 0 to 1, ascending.
    scaled: Vec<Trials>,
    /// x at 0 and the range of x.
    from: f64,
    range: f64,
    /// a and b of the scaled x.
    scaled_coefficients: [f64; 2],
    /// The penalised log-likelihood there.
    largest: f64,
}

/// The value of the parameter at which the outcome has a given probability.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ValueAt {
    /// The probability.
    pub probability: f64,
    /// The value.
    pub value: f64,
    /// Ends of its 95 % confidence interval, ascending. None: the runs set no bound on that side.
    pub between: [Option<f64>; 2],
}

impl Logistic {
    /// The fit. None: x has fewer than two values, or a value is not finite, or either all runs
    /// have the outcome or none has.
    pub fn fit(trials: &[Trials]) -> Option<Self> {
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        let wider = |[low, high]: [f64; 2], one: &Trials| [low.min(one.x), high.max(one.x)];
        let [from, to] = trials.iter().fold(ends, wider);
        let runs: usize = trials.iter().map(|one| one.runs).sum();
        let with_outcome: usize = trials.iter().map(|one| one.with_outcome).sum();
        let range = to - from;
        if !(range > 0.0 && range.is_finite()) || with_outcome == 0 || with_outcome == runs {
            return None;
        }
        let scaled = trials.iter().map(|one| Trials {
            x: (one.x - from) / range,
            ..*one
        });
        let mut scaled: Vec<Trials> = scaled.collect();
        scaled.sort_by(|a, b| a.x.total_cmp(&b.x));
        let mut fit = Self {
            scaled,
            from,
            range,
            scaled_coefficients: [0.0; 2],
            largest: 0.0,
        };
        (fit.scaled_coefficients, fit.largest) = fit.maximum();
        Some(fit)
    }

    /// The intercept a and the slope b, the latter per unit of x.
    pub fn coefficients(&self) -> [f64; 2] {
        let [a, b] = self.scaled_coefficients;
        [a - b * self.from / self.range, b / self.range]
    }

    /// The probability at a value of x.
    pub fn probability(&self, x: f64) -> f64 {
        let [a, b] = self.scaled_coefficients;
        logistic(a + b * self.scaled(x))
    }

    /// The 95 % confidence interval of the probability at a value of x.
    pub fn band(&self, x: f64) -> [f64; 2] {
        let [a, b] = self.scaled_coefficients;
        let x = self.scaled(x);
        let middle = a + b * x;
        [-1.0, 1.0].map(|side| {
            let is_rejected = |distance: f64| self.is_rejected(x, middle + side * distance);
            // Beyond it a probability is 0 or 1.
            let far = (1..=10)
                .map(|k| f64::from(1 << k))
                .find(|far| is_rejected(*far));
            let end = far.map(|far| end_of(0.0, far, is_rejected));
            logistic(end.map_or(side * f64::INFINITY, |distance| middle + side * distance))
        })
    }

    /// The value of x with this probability, between 0 and 1. None: the curve does not reach it near
    /// the runs.
    pub fn value_at(&self, probability: f64) -> Option<ValueAt> {
        let wanted = (probability / (1.0 - probability)).ln();
        let [a, b] = self.scaled_coefficients;
        let x = (wanted - a) / b;
        // Farther away the runs say nothing; a level curve has it nowhere.
        if x.is_nan() || x.abs() > FARTHEST {
            return None;
        }
        let between = [-1.0, 1.0].map(|side| {
            let is_rejected = |distance: f64| self.is_rejected(x + side * distance, wanted);
            let mut far = (-10..)
                .map(|k| 2.0_f64.powi(k))
                .take_while(|far| *far <= FARTHEST);
            let far = far.find(|far| is_rejected(*far))?;
            Some(self.from + self.range * (x + side * end_of(0.0, far, is_rejected)))
        });
        Some(ValueAt {
            probability,
            value: self.from + self.range * x,
            between,
        })
    }

    /// Whether the runs show, with a confidence of 95 %, that the probability depends on x.
    pub fn depends(&self) -> bool {
        let runs: usize = self.scaled.iter().map(|one| one.runs).sum();
        let with_outcome: usize = self.scaled.iter().map(|one| one.with_outcome).sum();
        // The penalty keeps the best constant from the fraction itself, but for little.
        let fraction = with_outcome as f64 / runs as f64;
        let middle = (fraction / (1.0 - fraction)).ln();
        let at = |distance: f64| self.penalised([middle + distance, 0.0]);
        self.largest - largest_of(&at, 2.0) > REJECTED
    }

    /// Whether a value of x separates the runs with the outcome from those without: the likelihood
    /// alone then has no maximum.
    pub fn is_separated(&self) -> bool {
        let of = |wanted: bool| {
            let has = move |one: &&Trials| match wanted {
                true => one.with_outcome > 0,
                false => one.with_outcome < one.runs,
            };
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let all = self.scaled.iter().filter(has);
            all.fold(ends, |[low, high], one| [low.min(one.x), high.max(one.x)])
        };
        let ([with_low, with_high], [without_low, without_high]) = (of(true), of(false));
        without_high <= with_low || with_high <= without_low
    }

    fn scaled(&self, x: f64) -> f64 {
        (x - self.from) / self.range
    }

    /// The largest penalised log-likelihood and its coefficients, by Newton's method on Firth's
    /// modified scores.
    fn maximum(&self) -> ([f64; 2], f64) {
        let mut at = [0.0; 2];
        let mut value = self.penalised(at);
        for _ in 0..MOST_STEPS {
            let mut step = self.step(at);
            let longest = step[0].abs().max(step[1].abs());
            if !longest.is_finite() || longest < 1e-10 * (1.0 + at[0].abs().max(at[1].abs())) {
                break;
            }
            if longest > LONGEST_STEP {
                step = step.map(|change| change * LONGEST_STEP / longest);
            }
            let next = |part: f64| [at[0] + part * step[0], at[1] + part * step[1]];
            if longest < SURE_STEP {
                (at, value) = (next(1.0), self.penalised(next(1.0)));
                continue;
            }
            let mut parts = (0..30).map(|k| next(0.5_f64.powi(k)));
            let Some(better) = parts.find(|next| self.penalised(*next) > value) else {
                break;
            };
            (at, value) = (better, self.penalised(better));
        }
        (at, value)
    }

    /// The step of Newton's method: the inverse of the information times the modified scores.
    fn step(&self, at: [f64; 2]) -> [f64; 2] {
        let [[aa, ab], [_, bb]] = self.information(at);
        let determinant = aa * bb - ab * ab;
        let mut scores = [0.0; 2];
        for one in &self.scaled {
            let p = logistic(at[0] + at[1] * one.x);
            let runs = one.runs as f64;
            // The leverage of one run.
            let weight = p * (1.0 - p);
            let leverage = weight * (bb - 2.0 * ab * one.x + aa * one.x * one.x) / determinant;
            let score = one.with_outcome as f64 - runs * p + runs * leverage * (0.5 - p);
            scores[0] += score;
            scores[1] += score * one.x;
        }
        [
            (bb * scores[0] - ab * scores[1]) / determinant,
            (aa * scores[1] - ab * scores[0]) / determinant,
        ]
    }

    fn information(&self, [a, b]: [f64; 2]) -> [[f64; 2]; 2] {
        let mut sums = [0.0; 3];
        for one in &self.scaled {
            let p = logistic(a + b * one.x);
            let weight = one.runs as f64 * p * (1.0 - p);
            sums[0] += weight;
            sums[1] += weight * one.x;
            sums[2] += weight * one.x * one.x;
        }
        [[sums[0], sums[1]], [sums[1], sums[2]]]
    }

    /// The log-likelihood with Firth's penalty.
    fn penalised(&self, [a, b]: [f64; 2]) -> f64 {
        let likelihood = self.scaled.iter().map(|one| {
            let eta = a + b * one.x;
            let without = (one.runs - one.with_outcome) as f64;
            // ln p = -ln(1 + exp(-eta)), ln(1 - p) = -ln(1 + exp(eta))
            -(one.with_outcome as f64 * softplus(-eta) + without * softplus(eta))
        });
        let [[aa, ab], [_, bb]] = self.information([a, b]);
        let determinant = aa * bb - ab * ab;
        let penalty = 0.5 * determinant.max(f64::MIN_POSITIVE).ln();
        likelihood.sum::<f64>() + penalty
    }

    /// Whether the runs reject that the log of the odds at `x` is `eta`: x scaled.
    fn is_rejected(&self, x: f64, eta: f64) -> bool {
        // Slopes from the flattest to the steepest of either sign, by their inverse hyperbolic
        // sine, which is even in small and in large ones.
        let along = |slope: f64| self.penalised([eta - slope.sinh() * x, slope.sinh()]);
        let distances = self.scaled.windows(2).map(|two| two[1].x - two[0].x);
        let nearest = distances.filter(|d| *d > 0.0).fold(1.0, f64::min);
        self.largest - largest_of(&along, (STEEPEST / nearest).asinh()) > REJECTED
    }
}

/// The largest value of a function between `-to` and `to`.
fn largest_of(function: &dyn Fn(f64) -> f64, to: f64) -> f64 {
    let width = to / f64::from(TRIED);
    let tried = (-TRIED..=TRIED).map(|k| f64::from(k) * width);
    let mut best = tried
        .map(|x| (x, function(x)))
        .fold((0.0, f64::NEG_INFINITY), |best, one| {
            if one.1 > best.1 { one } else { best }
        });
    // Golden section.
    let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
    let [mut low, mut high] = [best.0 - width, best.0 + width];
    while high - low > 1e-6 * width {
        let inner = [high - ratio * (high - low), low + ratio * (high - low)];
        let values = inner.map(function);
        for (x, value) in inner.into_iter().zip(values) {
            if value > best.1 {
                best = (x, value);
            }
        }
        if values[0] > values[1] {
            high = inner[1];
        } else {
            low = inner[0];
        }
    }
    best.1
}

/// Where `is_rejected` becomes true between `kept` and `rejected`.
fn end_of(mut kept: f64, mut rejected: f64, is_rejected: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(kept, rejected);
        if is_rejected(middle) {
            rejected = middle;
        } else {
            kept = middle;
        }
        if rejected - kept < 1e-9 * rejected {
            break;
        }
    }
    rejected
}

fn logistic(eta: f64) -> f64 {
    1.0 / (1.0 + (-eta).exp())
}

/// ln(1 + exp(x)).
fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

/// The 95 % confidence interval of a probability from a number of runs, at least one, of which so
/// many have the outcome (Wilson 1927).
pub fn wilson(runs: usize, with_outcome: usize) -> [f64; 2] {
    let (n, z) = (runs as f64, crate::student::NORMAL);
    let fraction = with_outcome as f64 / n;
    let middle = fraction + z * z / (2.0 * n);
    let half = z * (fraction * (1.0 - fraction) / n + z * z / (4.0 * n * n)).sqrt();
    // Rounding alone leaves the range of a probability.
    [middle - half, middle + half].map(|end| (end / (1.0 + z * z / n)).clamp(0.0, 1.0))
}

/// What the probability of an outcome is below, with a confidence of 95 %, if none of this number
/// of runs, at least one, has it.
pub fn bound_of_none(runs: usize) -> f64 {
    1.0 - 0.05_f64.powf(1.0 / runs as f64)
}
