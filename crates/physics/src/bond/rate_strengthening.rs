//! How strengths rise with the strain rate: by eq. 20 of Platzer 2022, or by a table; with the
//! present rate, or with the largest that a bond has had.

use serde::{Deserialize, Serialize};

use super::strain_rate::{BRANCH_1_S, HIGHEST_1_S, dynamic_increase_factor};

/// How the strengths of bonds rise with the strain rate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RateStrengthening {
    /// The factor over the rate.
    pub curve: IncreaseCurve,
    /// A bond keeps the largest factor that it has had.
    pub keeps_largest: bool,
}

impl RateStrengthening {
    /// Ratio of dynamic to static strength, 1 or more, at this strain rate: of bonds that keep the
    /// largest factor, at the largest rate so far.
    pub fn factor(&self, rate_1_s: f64) -> f64 {
        match self.keeps_largest {
            true => self.curve.largest_factor(rate_1_s),
            false => self.curve.factor(rate_1_s),
        }
    }
}

/// The largest strain rate that a bond has had so far, 1/s; 0 if it has only become shorter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct LargestRate(pub f64);

/// Ratio of dynamic to static strength over the strain rate.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub enum IncreaseCurve {
    /// Platzer 2022, eq. 20.
    Platzer {
        /// The factor is 1 below this rate, 1/s.
        from_1_s: f64,
    },
    /// Rates, 1/s, and factors: linear in the logarithm of the rate. Below the first rate the
    /// factor is 1, as eq. 20 below its own; above the last one it is constant. Rates are more than
    /// 0 and rise; factors are 1 or more and do not fall.
    Table(Vec<[f64; 2]>),
}

impl IncreaseCurve {
    /// Ratio of dynamic to static strength, 1 or more, at this strain rate.
    pub fn factor(&self, rate_1_s: f64) -> f64 {
        match self {
            Self::Platzer { from_1_s } => dynamic_increase_factor(rate_1_s, *from_1_s),
            Self::Table(rows) => interpolated(rows, rate_1_s),
        }
    }

    /// Above this rate the factor no longer rises, 1/s.
    pub fn highest_rate_1_s(&self) -> f64 {
        match self {
            Self::Platzer { .. } => HIGHEST_1_S,
            Self::Table(rows) => rows.last().map_or(0.0, |[rate, _]| *rate),
        }
    }

    /// The largest factor at any rate up to this one: that of a bond whose rate has risen to it
    /// from 0. It differs from [`IncreaseCurve::factor`] only where the fit of eq. 20 falls.
    pub fn largest_factor(&self, rate_1_s: f64) -> f64 {
        let factor = self.factor(rate_1_s);
        match self {
            Self::Platzer { from_1_s } if rate_1_s > *from_1_s => {
                factor.max(self.factor(BRANCH_1_S.clamp(*from_1_s, rate_1_s)))
            }
            _ => factor,
        }
    }
}

fn interpolated(rows: &[[f64; 2]], rate_1_s: f64) -> f64 {
    let after = rows.partition_point(|[rate, _]| *rate <= rate_1_s);
    let Some([lower_1_s, lower]) = after.checked_sub(1).map(|before| rows[before]) else {
        return 1.0;
    };
    let Some([upper_1_s, upper]) = rows.get(after) else {
        return lower;
    };
    let fraction = (rate_1_s / lower_1_s).ln() / (upper_1_s / lower_1_s).ln();
    lower + (upper - lower) * fraction
}
